#pragma once
// The mean of points.

#include "engine/types.h"

#include <span>

namespace toile {

/// (1/n) Σ pᵢ, of n ≥ 1 points; summed in their order.
inline Vec3 mean_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The same, of the points x[v] of the chosen vertices.
inline Vec3 mean_of(const Positions& x, std::span<const int> vertices) {
  Vec3 sum = Vec3::Zero();
  for (int v : vertices) sum += x[v];
  return sum / static_cast<double>(vertices.size());
}

}  // namespace toile
