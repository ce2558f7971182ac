#pragma once
// The heights of a panel that is folded in its plane: which layer lies over which.

#include "engine/types.h"

#include <functional>
#include <vector>

namespace toile {

/// A panel whose places overlap in its plane. Vertices of equal `joined` are one; triangles that this flattens or lays
/// on each other don't count.
struct FoldedPanel {
  std::vector<Triangle> triangles;
  std::vector<int> joined;     ///< by vertex: the vertex whose place and height stand for it
  std::vector<Vec2> plane;     ///< by vertex: where it lies in the plane [m]
  std::vector<double> height;  ///< by vertex: over the plane [m]
};

/// Its triangles that are left when what is joined is one, by their own vertices.
std::vector<Triangle> kept_triangles(const FoldedPanel& panel);

/// Raises and lowers the vertices until, wherever two places overlap, the one with the lower layer lies above the other
/// by `spacing` [m] times the difference of their layers, or at least above it where triangles that meet in a vertex
/// leave no room. `layer` is asked at points of triangles: three vertices and their weights. Heights that are so
/// already stay. The overlap of two triangles is a polygon whose corners are vertices over triangles and crossings of
/// edges, and height is linear on it: in order there is in order everywhere. Each is put in order in turn [projected
/// Gauss–Seidel], since one moves others; deterministic.
using LayerAt = std::function<double(const Triangle& vertices, const Vec3& weights)>;
void lay_in_order(FoldedPanel& panel, const LayerAt& layer, double spacing);

}  // namespace toile
