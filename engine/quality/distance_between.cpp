#include "engine/quality/distance_between.h"

#include "engine/geometry/bvh.h"
#include "engine/geometry/distance.h"
#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace toile {

namespace {

struct Sample {
  Vec3 point;
  double weight;
};

/// Half of a triangle's area goes to its barycentre, half to its corners.
std::vector<Sample> samples_of(const Positions& x, const std::vector<Triangle>& triangles) {
  std::vector<Sample> samples;
  for (const Vec3& p : x) samples.push_back({p, 0});
  for (const auto& [a, b, c] : triangles) {
    const double area = 0.5 * (x[b] - x[a]).cross(x[c] - x[a]).norm();
    for (int v : {a, b, c}) samples[v].weight += area / 6;
    samples.push_back({(x[a] + x[b] + x[c]) / 3, area / 2});
  }
  return samples;
}

DrapeDistance one_way(const std::vector<Sample>& from, const Positions& x, const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  for (const auto& [a, b, c] : triangles) boxes.push_back(triangle_box(x[a], x[b], x[c]));
  const Bvh bvh(boxes);
  std::vector<double> distance(from.size());
  parallel_for_each(static_cast<int>(from.size()), 256, [&](int i) {
    const auto squared = [&](int t) {
      const auto& [a, b, c] = triangles[t];
      return point_triangle(from[i].point, x[a], x[b], x[c]).squared_distance;
    };
    const int nearest = bvh.nearest(from[i].point, std::numeric_limits<double>::infinity(), squared);
    distance[i] = std::sqrt(squared(nearest));
  });
  DrapeDistance result;
  double total = 0;
  for (size_t i = 0; i < from.size(); ++i) {
    if (from[i].weight == 0) continue;
    total += from[i].weight;
    result.mean += from[i].weight * distance[i];
    result.max = std::max(result.max, distance[i]);
  }
  if (total > 0) result.mean /= total;
  return result;
}

}  // namespace

DrapeDistance vertex_distance(const Positions& a, const Positions& b) {
  if (a.size() != b.size()) throw std::invalid_argument("two drapes of different vertex counts");
  DrapeDistance result;
  for (size_t i = 0; i < a.size(); ++i) {
    const double distance = (a[i] - b[i]).norm();
    result.mean += distance / static_cast<double>(a.size());
    result.max = std::max(result.max, distance);
  }
  return result;
}

DrapeDistance surface_distance(const Positions& a, const std::vector<Triangle>& triangles_a, const Positions& b,
                               const std::vector<Triangle>& triangles_b) {
  if (triangles_a.empty() || triangles_b.empty()) throw std::invalid_argument("a surface without triangles");
  const DrapeDistance there = one_way(samples_of(a, triangles_a), b, triangles_b);
  const DrapeDistance back = one_way(samples_of(b, triangles_b), a, triangles_a);
  return {0.5 * (there.mean + back.mean), std::max(there.max, back.max)};
}

}  // namespace toile
