#include "engine/scene/stretch_test.h"

#include "engine/scene/problem.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace toile;

namespace {

Fabric linear_fabric() {
  Fabric fabric;
  fabric.stretch_stiffness = {1000, 600, 50};
  return fabric;
}

/// Code and pointer of the refusal; empty where there is none.
std::pair<std::string, std::string> refusal(const StretchTest& test, double poisson_ratio = 0.2) {
  Fabric fabric = linear_fabric();
  try {
    apply_stretch_test(test, poisson_ratio, "/stretch_curve", fabric);
  } catch (const InputError& error) {
    return {error.problems().front().code, error.problems().front().pointer};
  }
  return {};
}

}  // namespace

TEST(StressCurve, PassesThroughItsPointsAndRisesBetweenThem) {
  const std::vector<Vec2> points = {{0.01, 1}, {0.02, 1.1}, {0.05, 40}, {0.06, 300}, {0.2, 301}};
  const StressCurve curve = monotone_stress_curve(points);
  double low = 0;
  for (const Vec2& p : points) {
    EXPECT_NEAR(curve.at(p.x()).stress, p.y(), 1e-10 * p.y());
    // Neither stress nor tangent jumps there.
    const auto before = curve.at(p.x() - 1e-12), after = curve.at(p.x() + 1e-12);
    EXPECT_NEAR(before.stress, after.stress, 1e-6);
    EXPECT_NEAR(before.tangent, after.tangent, 1e-4 * after.tangent + 1e-6);
    low = p.x();
  }
  double last = -1e9;
  for (double e = -0.1; e < low + 0.1; e += 1e-4) {
    EXPECT_GT(curve.at(e).stress, last) << e;
    EXPECT_GE(curve.at(e).tangent, curve.least_tangent() * (1 - 1e-12)) << e;
    last = curve.at(e).stress;
  }
  EXPECT_GT(curve.least_tangent(), 0);
}

TEST(StressCurve, EnergyIsTheIntegral) {
  const StressCurve curve = monotone_stress_curve({{0.01, 1}, {0.03, 10}, {0.05, 40}}, 7);
  double sum = 0;
  const double step = 1e-5;
  for (int k = 0; k < 12000; ++k) sum += step * curve.at(-0.02 + (k + 0.5) * step).stress;
  EXPECT_NEAR(curve.energy(0.1) - curve.energy(-0.02), sum, 1e-7 * sum);
  EXPECT_EQ(curve.energy(0), 0);
}

TEST(StressCurve, ALineStaysALine) {
  const StressCurve curve = monotone_stress_curve({{0.1, 10}, {0.2, 20}, {0.3, 30}});
  for (double e : {-0.5, 0.0, 0.05, 0.13, 0.29, 0.7}) {
    EXPECT_NEAR(curve.at(e).stress, 100 * e, 1e-12);
    EXPECT_NEAR(curve.at(e).tangent, 100, 1e-9);
  }
}

TEST(StretchTest, ReadingsThatCanNotBeAFabricAreRefusedWithTheirPlace) {
  using Refusal = std::pair<std::string, std::string>;
  EXPECT_EQ(refusal({{{0.01, 5}, {0.02, 20}}, {}, {}}), Refusal());
  EXPECT_EQ(refusal({{{0.01, 5}, {0.02, 5}}, {}, {}}), Refusal("curve_not_rising", "/stretch_curve/warp/1"));
  EXPECT_EQ(refusal({{}, {{0.02, 5}, {0.01, 7}}, {}}), Refusal("curve_not_rising", "/stretch_curve/weft/1"));
  EXPECT_EQ(refusal({{}, {{0, 0}, {0.01, 7}}, {}}), Refusal("curve_not_rising", "/stretch_curve/weft/0"));
  EXPECT_EQ(refusal({{{0.1, 50}, {0.2, 54}}, {}, {}}), Refusal("curve_not_rising", "/stretch_curve/warp/1"));
  // At 45° a strip can't be stiffer than warp and weft in a row: 4/(1/1000 + 1/600).
  EXPECT_EQ(refusal({{}, {}, {{0.01, 20}, {0.02, 50}}}), Refusal("curve_too_stiff", "/stretch_curve/bias/0"));
  EXPECT_EQ(refusal({{{0.5, 100}, {1.2, 400}}, {}, {}}, 0.6), Refusal("poisson_too_large", "/stretch_curve/warp/1"));
  EXPECT_EQ(refusal({{{0.01, 100}, {0.1, 112}}, {{0.01, 100}, {0.1, 112}}, {}}, 0.5),
            Refusal("curve_too_soft", "/stretch_curve"));
}
