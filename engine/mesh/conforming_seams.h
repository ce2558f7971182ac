#pragma once
// Stitches of a garment mesh join a vertex to a point on an edge; the engine sews vertices to vertices. This makes
// both sides of such seams conform.

#include "engine/mesh/triangle_mesh.h"

#include <string>
#include <utility>
#include <vector>

namespace toile {

/// Turns mesh.stitches (then emptied) into pairs of vertices. Runs of stitches along one boundary are matched as two
/// polylines: a vertex within a third of an edge of a vertex opposite is paired with it, one to one, nearest first;
/// every other vertex of either side gets a partner by splitting the edge opposite (and its triangles; UVs and
/// positions interpolated). New vertices come after the given ones. Throws InputError at `pointer` with
/// `unknown_edge` where a stitch names two vertices that no triangle edge joins. Deterministic.
std::vector<std::pair<int, int>> conform_stitches(TriangleMesh& mesh, const std::string& pointer);

}  // namespace toile
