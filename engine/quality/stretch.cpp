#include "engine/quality/stretch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace toile {

TriangleStretch triangle_stretch(const std::vector<std::array<Vec2, 3>>& flat, const std::vector<Triangle>& triangles,
                                 const Positions& x) {
  assert(flat.size() == triangles.size());
  const size_t n = triangles.size();
  TriangleStretch result{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<double>(n),
                         std::vector<double>(n)};
  for (size_t t = 0; t < n; ++t) {
    Mat2 rest;
    rest << flat[t][1] - flat[t][0], flat[t][2] - flat[t][0];
    const double twice_area = rest.determinant();
    if (twice_area == 0) continue;
    const auto& [a, b, c] = triangles[t];
    Eigen::Matrix<double, 3, 2> now;
    now << x[b] - x[a], x[c] - x[a];
    Mat2 adjugate;
    adjugate << rest(1, 1), -rest(0, 1), -rest(1, 0), rest(0, 0);
    const Eigen::Matrix<double, 3, 2> f = now * adjugate / twice_area;
    result.weft[t] = f.col(0).norm() - 1;
    result.warp[t] = f.col(1).norm() - 1;
    const double diagonal = std::max((f.col(0) + f.col(1)).norm(), (f.col(0) - f.col(1)).norm());
    result.bias[t] = diagonal / std::numbers::sqrt2 - 1;
    result.area[t] = 0.5 * std::abs(twice_area);
    const Mat2 metric = f.transpose() * f;
    const double middle = 0.5 * metric.trace(), away = std::hypot(0.5 * (metric(0, 0) - metric(1, 1)), metric(0, 1));
    result.smallest[t] = std::sqrt(std::max(0.0, middle - away)) - 1;
  }
  return result;
}

StretchStatistics stretch_statistics(const std::vector<double>& stretch, const std::vector<double>& area) {
  assert(stretch.size() == area.size());
  std::vector<int> order(stretch.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return stretch[a] < stretch[b] || (stretch[a] == stretch[b] && a < b); });
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  StretchStatistics statistics;
  if (!(total > 0)) return statistics;
  double below = 0;
  for (int t : order) {
    if (area[t] == 0) continue;
    statistics.mean += stretch[t] * area[t] / total;
    if (below == 0) statistics.min = stretch[t];
    const auto reaches = [&](double share) { return below < share * total && below + area[t] >= share * total; };
    if (reaches(0.01)) statistics.p01 = stretch[t];
    if (reaches(0.5)) statistics.median = stretch[t];
    if (reaches(0.99)) statistics.p99 = stretch[t];
    statistics.max = stretch[t];
    below += area[t];
  }
  return statistics;
}

}  // namespace toile
