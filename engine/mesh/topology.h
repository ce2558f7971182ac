#pragma once
// What is next to what in a list of triangles. Winding need not be consistent: seams that turn the fabric over
// (right_wrong) join triangles that run the same way along their edge. Pure functions; order of results is fixed by the
// input's order only.

#include "engine/types.h"

#include <vector>

namespace toile {

/// An undirected edge, v0 < v1, with the first two triangles on it (b = -1: on the boundary) and how many there are.
struct MeshEdge {
  int v0, v1;
  int triangle_a, triangle_b;
  int triangle_count;
};

/// Every edge once, sorted by (v0, v1); triangles ascending.
std::vector<MeshEdge> mesh_edges(const std::vector<Triangle>& triangles);

/// Two triangles (v0, v1, v2) and (v1, v0, v3) on the edge v0–v1. v0 → v1 is the direction in which triangle_a runs;
/// triangle_b may run either way. Only edges with exactly two triangles have a hinge.
struct Hinge {
  int v0, v1;  ///< the edge
  int v2, v3;  ///< opposite in triangle_a, in triangle_b
  int triangle_a, triangle_b;
};

std::vector<Hinge> hinges(const std::vector<Triangle>& triangles);

/// Triangles around each vertex, ascending: those of v are triangles[first[v]] … triangles[first[v + 1] − 1].
struct VertexTriangles {
  std::vector<int> first;
  std::vector<int> triangles;
};

VertexTriangles vertex_triangles(const std::vector<Triangle>& triangles, int vertex_count);

/// Closed chains of boundary edges (one triangle each), as vertices in order. Where a boundary touches itself at a
/// vertex it may be cut into loops in more than one way; the lowest-numbered edge is taken.
std::vector<std::vector<int>> boundary_loops(const std::vector<Triangle>& triangles);

/// Edges with more than two triangles.
std::vector<MeshEdge> non_manifold_edges(const std::vector<Triangle>& triangles);

/// Per triangle, the number of its edge-connected component; numbered by first triangle.
std::vector<int> connected_components(const std::vector<Triangle>& triangles);

/// Used vertices − edges + triangles.
long euler_characteristic(const std::vector<Triangle>& triangles);

}  // namespace toile
