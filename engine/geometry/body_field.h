#pragma once
// The body as collision detection sees it: a signed distance function.

#include "engine/geometry/box.h"
#include "engine/geometry/solid.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/scene/body.h"
#include "engine/types.h"

#include <memory>
#include <string>
#include <vector>

namespace toile {

/// Signed distance to a body. Immutable and cheap to copy; any number of threads may sample at once.
class BodyField {
 public:
  using Sample = FieldSample;

  explicit BodyField(std::shared_ptr<const Solid> solid) : solid_(std::move(solid)) {}

  /// Signed distance [m]: positive outside, negative inside, however deep. Farther outside than band() it is no less
  /// than band() and grows away from the body, but is not the true distance.
  double distance(const Vec3& point) const { return solid_->distance(point); }
  /// Distance and the normalised gradient, which points outwards; finite and of unit length everywhere, also on medial
  /// axes and beyond the band.
  Sample sample(const Vec3& point) const { return solid_->sample(point); }

  double band() const { return solid_->band(); }
  Box bounds() const { return solid_->bounds(); }
  TriangleMesh surface() const { return solid_->surface(); }
  /// What was found wrong with the body and how it was taken, in sentences for people.
  std::vector<std::string> warnings() const { return solid_->warnings(); }

  /// The body without the parts that hang from above: what can't be reached inside it from its feet by going sideways
  /// or up only, where that is at least 100 mm tall. Arms and hands in an A-pose go, cut level with the armpits; legs,
  /// torso and head stay. Panels of skirts and trousers ignore hands while they are sewn.
  BodyField without_overhangs() const;
  /// The body with its feet pointing down: what lies lower than ankle() goes straight on from there. Legs
  /// of trousers mind it while they are sewn, or they would close under the soles. A body without end stays as it is.
  BodyField with_pointed_toes() const;
  /// The height [m] below which feet are.
  double ankle() const;

 private:
  std::shared_ptr<const Solid> solid_;
};

/// Primitives are exact. Meshes and the dress form are sampled on a grid of about a third of `edge_length` [m] near the
/// surface (engine/geometry/mesh_solid.h). Throws InputError `body_not_solid` at /body/mesh for a mesh without inside.
BodyField make_body_field(const Body& body, double edge_length);

}  // namespace toile
