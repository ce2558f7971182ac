#pragma once
// Makes a solid of a triangle mesh as bodies really come: crossing itself, with small holes, wound either way.

#include "engine/geometry/distance_grid.h"
#include "engine/mesh/triangle_mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace toile {

struct SolidSurface {
  SoupSolid solid;
  TriangleMesh oriented;  ///< the mesh as given, every part wound outwards
  std::vector<std::string> warnings;
};

/// Inside is where the generalised winding number exceeds ½. Vertices at the same place are one, and so are
/// triangles of the same corners wound alike; walls between parts put together go; triangles wound against their
/// neighbours are turned, and then connected parts with a negative volume; pieces of the surface that don't separate
/// inside from outside (within other parts, in the overlap of a fold) are cut off to within a millimetre; holes are
/// closed by the ½ level of the winding number. `spacing` [m] is the grid's that the surface is for. Throws InputError
/// `body_not_solid` at /body/mesh where the holes are as large as the surface (an open sheet) or nothing separates
/// inside from outside.
SolidSurface make_solid_surface(const TriangleMesh& mesh, double spacing);

/// Where on triangles a condition holds: calls keep(a, b, c) with those triangles and parts of triangles on which
/// `condition` is true. A triangle longer than `largest` [m], or on whose corners and centre the condition differs, is
/// split in four, the latter down to `smallest` [m].
using TriangleCondition = std::function<bool(const Vec3& point, const Vec3& unit_normal)>;
void keep_where(const Vec3& a, const Vec3& b, const Vec3& c, const TriangleCondition& condition, double largest,
                double smallest, const std::function<void(const Vec3&, const Vec3&, const Vec3&)>& keep);

}  // namespace toile
