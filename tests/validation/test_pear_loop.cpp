// The pear loop against the elastica: half a loop is integrated from the clamp, and two shots, the clamp's curvature
// and the level force, must bring it to the middle plane, running level.

#include "engine/experiments/pear_loop.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/silent.h"

#include <Eigen/LU>
#include <cstdio>

using namespace toile;
using namespace toile::test;

namespace {

/// Of a loop of unit length: height over length, where `weight` = areal density · g · length³ / D. Lengths over the
/// strip's, forces per width over D / length²: θ″ = w (½ − s) sin θ − P cos θ with θ from straight down, outwards.
class Elastica {
 public:
  explicit Elastica(double weight) : weight_(weight) {}

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

}  // namespace

TEST(PearLoop, ElasticaIsPeircesWithoutWeight) {
  const double ours = Elastica(0).height();
  std::printf("weightless: height %.4f of the length, Peirce 1930: 0.4243\n", ours);
  EXPECT_NEAR(ours, 0.4243, 5e-4);
}

TEST(PearLoop, HeightIsTheElasticas) {
  Silent monitor;
  for (const auto& [direction, stiffness] : {std::pair{Direction::warp, 40e-6}, {Direction::weft, 20e-6}}) {
    Fabric fabric = isotropic_fabric(0.2, 1000, 500, 0, 0);
    fabric.bending_stiffness = {40e-6, 20e-6, 30e-6};
    fabric.thickness = 2e-4;
    const double weight = 0.2 * kGravity * std::pow(0.15, 3) / stiffness;
    const double expected = 0.15 * Elastica(weight).height();
    const PearLoopResult ours = hang_loop({fabric, direction}, 1, monitor);
    std::printf("weight %.0f D/L2: height %.2f mm, reference %.2f mm, weightless %.2f mm, error %.2f %%\n", weight,
                1e3 * ours.report.height, 1e3 * expected, 63.65, 100 * (ours.report.height / expected - 1));
    EXPECT_NEAR(ours.report.height, expected, 0.005 * expected);
    EXPECT_EQ(ours.drape.report.status, "converged");
  }
}
