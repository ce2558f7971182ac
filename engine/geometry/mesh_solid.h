#pragma once
// A body given as a triangle mesh, as a sampled distance field.

#include "engine/geometry/solid.h"
#include "engine/mesh/triangle_mesh.h"

namespace toile {

/// The mesh is made solid as in solid_surface.h and sampled as in distance_grid.h, near the surface at about a third of
/// `edge_length` [m]: 2 to 6 mm, wider where the surface is so large that the grid would take more than about 100 MB.
/// Throws InputError `body_not_solid`.
std::shared_ptr<const Solid> make_mesh_solid(const TriangleMesh& mesh, double edge_length);

}  // namespace toile
