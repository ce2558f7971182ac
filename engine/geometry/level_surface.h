#pragma once
// The zero level of a function sampled on a lattice, as triangles.

#include "engine/geometry/distance_grid.h"
#include "engine/mesh/triangle_mesh.h"

#include <vector>

namespace toile {

/// Marching tetrahedra: six to a cell around its diagonal, linear along edges, so that neighbours meet exactly.
/// Negative is inside; triangles are counter-clockwise seen from the positive side. Vertices are not shared.
TriangleMesh level_surface(const Lattice& lattice, const std::vector<double>& values);

}  // namespace toile
