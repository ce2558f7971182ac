#pragma once
// The hanging pear loop as an elastica: half a loop is integrated from the clamp, and two shots, the clamp's curvature
// and the level force, must bring it to the middle plane, running level.

#include "engine/types.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::test {

/// Of a loop of unit length: height over length, where `weight` = areal density · g · length³ / D. Lengths over the
/// strip's, forces per width over D / length²: θ″ = w (½ − s) sin θ − P cos θ with θ from straight down, outwards.
class PearElastica {
 public:
  explicit PearElastica(double weight) : weight_(weight) {}

  double height() {
    Vec2 shots(4, 10);
    for (double now = 0; now < weight_ + 1e-9; now += std::max(1.0, weight_ / 40))
      shots = solve(shots, std::min(now, weight_));
    shots = solve(shots, weight_);
    return -end(shots, weight_)[1];
  }

 private:
  using Point = Eigen::Matrix<double, 4, 1>;  // x, y, θ, κ

  static Point end(const Vec2& shots, double weight) {
    constexpr int kSteps = 2000;
    const double h = 0.5 / kSteps;
    const auto slope = [&](double s, const Point& p) {
      return Point(std::sin(p[2]), -std::cos(p[2]), p[3],
                   weight * (0.5 - s) * std::sin(p[2]) - shots[1] * std::cos(p[2]));
    };
    Point p(0, 0, 0, shots[0]);
    for (int k = 0; k < kSteps; ++k) {
      const double s = k * h;
      const Point a = slope(s, p), b = slope(s + h / 2, p + h / 2 * a), c = slope(s + h / 2, p + h / 2 * b),
                  d = slope(s + h, p + h * c);
      p += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return p;
  }

  static Vec2 miss(const Vec2& shots, double weight) {
    const Point p = end(shots, weight);
    return {p[0], p[2] + std::numbers::pi / 2};
  }

  static Vec2 solve(Vec2 shots, double weight) {
    for (int k = 0; k < 50 && miss(shots, weight).norm() > 1e-12; ++k) {
      const double d = 1e-5;
      Mat2 jacobian;
      for (int i = 0; i < 2; ++i)
        jacobian.col(i) = (miss(shots + d * Vec2::Unit(i), weight) - miss(shots - d * Vec2::Unit(i), weight)) / (2 * d);
      const Vec2 step = jacobian.inverse() * miss(shots, weight);
      shots -= step * std::min(1.0, 5 / step.norm());
    }
    EXPECT_LT(miss(shots, weight).norm(), 1e-9) << weight;
    return shots;
  }

  double weight_;
};

}  // namespace toile::test
