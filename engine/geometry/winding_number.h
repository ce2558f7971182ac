#pragma once
// Generalised winding number of a triangle soup: how often a surface surrounds a point, also when it has holes or
// crosses itself.

#include "engine/geometry/box.h"
#include "engine/types.h"

#include <array>
#include <vector>

namespace toile {

/// w(q) = Σ Ω_t(q) / 4π over the triangles, Ω the signed solid angle (van Oosterom & Strackee 1983): 1 inside a closed
/// surface with outward normals, 0 outside, between them at holes (Jacobson et al. 2013). Groups of triangles that lie
/// farther away than kFar times their radius count as one dipole (Barill et al. 2018, order 0), which is right within
/// about 0.01. The jump across a triangle is exactly 1. Immutable; concurrent calls are safe.
class WindingNumber {
 public:
  WindingNumber(const Positions& vertices, const std::vector<Triangle>& triangles);
  double operator()(const Vec3& q) const;

 private:
  struct Node {
    Vec3 center;  ///< area-weighted
    Vec3 area;    ///< Σ ½ (b − a) × (c − a)
    double far2;  ///< squared distance from which the dipole is used
    int skip, first, last;
  };
  static constexpr double kFar = 2.5;

  void build(std::vector<int>& order, int begin, int end);

  std::vector<std::array<Vec3, 3>> corners_;  ///< in leaf order
  std::vector<Node> nodes_;                   ///< preorder
};

}  // namespace toile
