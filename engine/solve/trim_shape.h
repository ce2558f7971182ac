#pragma once
// The shape of a trim as contact sees it: a distance field in its own frame, and points on its surface.

#include "engine/geometry/solid.h"

#include <memory>
#include <vector>

namespace toile {

/// Cloth is held against the field, the points against the body's field. Both are convex, so the half space beyond a
/// nearest point never holds a part of the trim. Cheap to copy; without a solid it touches nothing.
struct TrimShape {
  std::shared_ptr<const Solid> solid;  ///< in the body frame (rigid_body.h), exact
  std::vector<Vec3> points;            ///< on the surface [m]
  double reach = 0;                    ///< the farthest point of it from the centre of mass [m]
  double size = 0;                     ///< its smaller half width [m]
};

/// A disc, its axis along z [m]. The points are a 16-gon around either rim, which lies within 2 % of the radius of it,
/// an 8-gon at half the radius and the middle of either face.
TrimShape disc_shape(double diameter, double thickness);

/// A box about the origin [m]. The points are its corners and the middles of its edges and faces.
TrimShape box_shape(const Vec3& size);

}  // namespace toile
