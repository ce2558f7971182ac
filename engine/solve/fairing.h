#pragma once
// Lays a small patch of cloth anew as the smoothest surface that its surroundings allow.

#include "engine/types.h"

#include <vector>

namespace toile {

/// Vertices within `edges` edges of those of `start`, ascending; includes them.
std::vector<int> vertices_around(const std::vector<int>& start, const std::vector<Triangle>& triangles,
                                 int vertex_count, int edges);

/// Moves the vertices of `patch` (indices into x, without repeats) to where
///   Σ_v |x_v − mean of its neighbours|²
/// is smallest, over the patch and its neighbours, everything else staying in place: a discrete thin plate (Kobbelt,
/// Campagna, Vorsatz and Seidel, "Interactive multi-resolution modeling on arbitrary meshes", SIGGRAPH 1998, §3.2). A
/// vertex of the mesh's boundary has its neighbours along the boundary only, so that a hem goes on as a smooth curve.
/// Folds and twists inside the patch are gone afterwards; its lengths are not kept. Triangles are those of the whole
/// surface. Leaves x alone and returns false where the patch has no surroundings that hold it.
bool fair(Positions& x, const std::vector<Triangle>& triangles, const std::vector<int>& patch);

}  // namespace toile
