#include "engine/quality/penetration.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr int kFine = 8;  ///< even, so that edge midpoints are among the samples

}  // namespace

Penetration deepest_penetration(const BodyField& body, const Positions& x, const std::vector<Triangle>& triangles) {
  Penetration deepest;
  const auto consider = [&](const Vec3& p, int triangle) {
    const double depth = -body.distance(p);
    if (depth > deepest.depth) deepest = {depth, p, triangle};
  };
  for (size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
    const Vec3 center = (a + b + c) / 3;
    const double reach = std::max({(a - center).norm(), (b - center).norm(), (c - center).norm()});
    // A distance changes by no more than the way walked: no point of this triangle can be inside.
    if (body.distance(center) > reach) continue;
    const int index = static_cast<int>(t);
    consider(center, index);
    for (int i = 0; i <= kFine; ++i) {
      for (int j = 0; i + j <= kFine; ++j) {
        consider((i * a + j * b + (kFine - i - j) * c) / kFine, index);
      }
    }
  }
  return deepest;
}

}  // namespace toile
