#pragma once
// What a body is to the rest of the engine: a solid that can be asked for its signed distance.

#include "engine/geometry/box.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/types.h"

#include <memory>
#include <string>
#include <vector>

namespace toile {

/// Signed distance [m], positive outside, and the unit normal that points away from the solid.
struct FieldSample {
  double distance = 0;
  Vec3 normal = Vec3::UnitY();
};

/// Immutable, so that any number of threads may ask at once. All answers are finite for finite points.
class Solid {
 public:
  virtual ~Solid() = default;
  virtual double distance(const Vec3& point) const = 0;
  virtual FieldSample sample(const Vec3& point) const = 0;
  /// How far outside the surface distances are true [m]; infinite for exact solids.
  virtual double band() const = 0;
  /// Of the solid itself; a half space is unbounded.
  virtual Box bounds() const = 0;
  /// For pictures, counter-clockwise seen from outside.
  virtual TriangleMesh surface() const = 0;
  /// See BodyField::without_overhangs(). Null: nothing hangs, take this one.
  virtual std::shared_ptr<const Solid> without_overhangs() const { return nullptr; }
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace toile
