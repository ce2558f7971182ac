#pragma once
// A triangulated polygon in the plane that knows its neighbours, so that edges can be flipped: the working form of the
// panel mesher.

#include "engine/types.h"

#include <vector>

namespace toile {

/// Triangles counter-clockwise. neighbours[t][i] is the triangle across the edge opposite to corner i, or -1.
struct PlaneMesh {
  std::vector<Vec2> points;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 3>> neighbours;
  std::vector<int> triangle_at;  ///< per point, one triangle around it (-1: none)

  /// Replaces the edge opposite to corner i of triangle t by the other diagonal of the two triangles beside it. The
  /// triangle across must exist and the quadrilateral must be convex.
  void flip(int t, int i);
};

/// The constrained Delaunay triangulation of a simple counter-clockwise polygon with points inside: every segment of
/// the outline is an edge, nothing outside remains, no point is added. points = outline, then inner.
/// Exact predicates on coordinates snapped to 2^-26 of the extent; Delaunay from Boost.Polygon's Voronoi diagram,
/// segments recovered by flips (Sloan, Computers & Structures 47, 1993). Throws std::runtime_error where an outline
/// touches itself within the snapping distance.
PlaneMesh constrained_delaunay(const std::vector<Vec2>& outline, const std::vector<Vec2>& inner);

/// Flips until every edge inside is locally Delaunay (in floating point, with a margin against endless flipping).
void flip_to_delaunay(PlaneMesh& mesh);

}  // namespace toile
