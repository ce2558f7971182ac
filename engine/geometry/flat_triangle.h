#pragma once
// Triangles of a flat pattern.

#include "engine/types.h"

#include <array>
#include <cmath>

namespace toile {

/// Area of the triangle [m²], never negative.
inline double flat_area(const std::array<Vec2, 3>& corner) {
  const Vec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

/// Mean length of its edges [m].
inline double mean_edge(const std::array<Vec2, 3>& corner) {
  return ((corner[1] - corner[0]).norm() + (corner[2] - corner[1]).norm() + (corner[0] - corner[2]).norm()) / 3;
}

}  // namespace toile
