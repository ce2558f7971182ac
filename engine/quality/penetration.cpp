#include "engine/quality/penetration.h"

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double kSpacing = 1e-3;        // [m] of samples
constexpr int kFewest = 8, kMost = 256;  // samples along an edge; the fewest even, so that midpoints are among them
constexpr double kExact = 1e-6;          // [m]

struct Corners {
  Vec3 a, b, c;
  Vec3 at(const Vec3& weights) const { return weights.x() * a + weights.y() * b + weights.z() * c; }
  double longest() const { return std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()}); }
};

int samples_along(double length) { return std::clamp(static_cast<int>(std::ceil(length / kSpacing)), kFewest, kMost); }

/// Walks on the triangle from a sample to a deeper one while there is one, by ever shorter steps from the samples'
/// spacing on.
void improve(const BodyField& body, const Corners& triangle, Vec3 weights, Penetration& deepest) {
  const double longest = triangle.longest();
  for (double stride = 1.0 / samples_along(longest); stride * longest > kExact; stride /= 2) {
    for (bool better = true; better;) {
      better = false;
      for (int from = 0; from < 3; ++from)
        for (int to = 0; to < 3; ++to) {
          Vec3 tried = weights;
          const double moved = std::min(stride, tried[from]);
          tried[from] -= moved;
          tried[to] += moved;
          const Vec3 p = triangle.at(tried);
          const double depth = -body.distance(p);
          if (!(depth > deepest.depth + 1e-3 * kExact)) continue;
          deepest.depth = depth;
          deepest.point = p;
          weights = tried;
          better = true;
        }
    }
  }
}

}  // namespace

Penetration deepest_penetration(const BodyField& body, const Positions& x, const std::vector<Triangle>& triangles) {
  Penetration deepest;
  Vec3 weights = Vec3::Zero();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Corners corners{x[triangles[t][0]], x[triangles[t][1]], x[triangles[t][2]]};
    const Vec3 center = corners.at(Vec3::Constant(1.0 / 3));
    const double reach =
        std::max({(corners.a - center).norm(), (corners.b - center).norm(), (corners.c - center).norm()});
    // A distance changes by no more than the way walked: no point of this triangle can be as deep.
    if (body.distance(center) + deepest.depth > reach) continue;
    const int n = samples_along(corners.longest());
    const auto consider = [&](const Vec3& w) {
      const Vec3 p = corners.at(w);
      const double depth = -body.distance(p);
      if (!(depth > deepest.depth)) return;
      deepest = {depth, p, static_cast<int>(t)};
      weights = w;
    };
    consider(Vec3::Constant(1.0 / 3));
    const double share = 1.0 / n;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n - i; ++j) consider(Vec3(share * i, share * j, share * (n - i - j)));
  }
  if (deepest.triangle >= 0) {
    const Triangle& t = triangles[deepest.triangle];
    improve(body, {x[t[0]], x[t[1]], x[t[2]]}, weights, deepest);
  }
  return deepest;
}

}  // namespace toile
