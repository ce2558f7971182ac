#include "engine/experiments/shadow.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace toile {
namespace {

constexpr double kPixel = 2e-4;  ///< [m]

/// As seen from above, x to the right.
Vec2 from_above(const Vec3& p) { return {p.x(), -p.z()}; }

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

double shadow_area_beyond(double radius, const Positions& x, const std::vector<Triangle>& triangles) {
  double reach = 0;
  for (const Vec3& p : x) reach = std::max(reach, from_above(p).cwiseAbs().maxCoeff());
  const int half = static_cast<int>(std::ceil(reach / kPixel)) + 1, side = 2 * half;
  const auto centre = [&](int pixel) { return (pixel - half + 0.5) * kPixel; };
  const auto pixel_at = [&](double place) { return std::clamp(static_cast<int>(place / kPixel + half), 0, side - 1); };
  std::vector<char> dark(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  for (const Triangle& t : triangles) {
    const std::array<Vec2, 3> p = {from_above(x[t[0]]), from_above(x[t[1]]), from_above(x[t[2]])};
    const double turn = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (int row = pixel_at(low.y()); row <= pixel_at(high.y()); ++row)
      for (int column = pixel_at(low.x()); column <= pixel_at(high.x()); ++column) {
        const Vec2 q(centre(column), centre(row));
        bool inside = q.squaredNorm() > radius * radius;
        for (int k = 0; k < 3 && inside; ++k) inside = turn * cross(p[(k + 1) % 3] - p[k], q - p[k]) >= 0;
        if (inside) dark[static_cast<std::size_t>(row) * side + column] = 1;
      }
  }
  return kPixel * kPixel * static_cast<double>(std::count(dark.begin(), dark.end(), 1));
}

std::vector<double> shadow_outline(double radius, const Positions& x, const std::vector<Triangle>& triangles,
                                   int count) {
  std::vector<double> outline(static_cast<std::size_t>(count), radius);
  const double step = 2 * std::numbers::pi / count;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      Vec2 a = from_above(x[t[k]]), b = from_above(x[t[(k + 1) % 3]]);
      if (cross(a, b) < 0) std::swap(a, b);
      const double from = std::atan2(a.y(), a.x()), turn = std::atan2(cross(a, b), a.dot(b));
      for (int ray = static_cast<int>(std::ceil(from / step)); ray * step <= from + turn; ++ray) {
        const Vec2 direction(std::cos(ray * step), std::sin(ray * step));
        const double slant = cross(direction, b - a);
        if (std::abs(slant) < 1e-15) continue;
        double& farthest = outline[static_cast<std::size_t>(((ray % count) + count) % count)];
        farthest = std::max(farthest, cross(a, b - a) / slant);
      }
    }
  return outline;
}

std::vector<double> harmonics(const std::vector<double>& outline, int highest) {
  std::vector<double> amplitudes;
  const double count = static_cast<double>(outline.size());
  for (int k = 0; k <= highest; ++k) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
      sum += std::polar(outline[i], -2 * std::numbers::pi * k * static_cast<double>(i) / count);
    amplitudes.push_back((k == 0 ? 1 : 2) * std::abs(sum) / count);
  }
  return amplitudes;
}

int node_count(const std::vector<double>& outline, double prominence) {
  // Going once around from the lowest point: a node ends where the outline has fallen by the prominence below its top.
  const std::size_t start = std::min_element(outline.begin(), outline.end()) - outline.begin();
  int nodes = 0;
  double top = outline[start], valley = outline[start];
  bool rising = false;
  for (std::size_t i = 1; i <= outline.size(); ++i) {
    const double r = outline[(start + i) % outline.size()];
    if (rising) {
      top = std::max(top, r);
      if (r <= top - prominence) ++nodes, rising = false, valley = r;
    } else {
      valley = std::min(valley, r);
      if (r >= valley + prominence) rising = true, top = r;
    }
  }
  return nodes;
}

}  // namespace toile
