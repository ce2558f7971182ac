#pragma once
// Does the cloth pass through itself? An exact answer that shares no code with the search for contacts.

#include "engine/types.h"

#include <vector>

namespace toile {

struct TrianglePair {
  int a, b;  ///< triangle indices, a < b
  bool operator==(const TrianglePair&) const = default;
};

/// All pairs of triangles that cross, ordered by a, then b. Decided exactly on the given doubles, so that a gap of any
/// width is a gap and a touch is a touch. Counted are
///   triangles without a common vertex: any common point, a touch too;
///   with one common vertex: a common point besides it;
///   with a common edge: lying on each other (coplanar, both on the same side of the edge);
///   with the same three vertices: always.
/// Triangles of exactly no area count as not there. Broad phase: uniform grid. Safe to call from many threads.
std::vector<TrianglePair> self_intersections(const Positions& x, const std::vector<Triangle>& triangles);

/// The narrow phase for one pair, by vertex indices into x.
bool triangles_cross(const Positions& x, const Triangle& first, const Triangle& second);

}  // namespace toile
