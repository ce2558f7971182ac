// The shadow of shapes whose area, outline and folds are known: a flat ring, a cone, a flower, cloth folded over
// itself.

#include "engine/experiments/shadow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

using namespace toile;

namespace {

struct Ring {
  Positions x;
  std::vector<Triangle> triangles;
};

/// A ring from 90 mm to 150 mm whose radius is made `shrink`(radius, angle).
Ring ring(const std::function<double(double, double)>& shrink) {
  constexpr int kRound = 360, kAcross = 12;
  Ring r;
  for (int i = 0; i <= kAcross; ++i)
    for (int k = 0; k < kRound; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRound, radius = shrink(0.09 + 0.06 * i / kAcross, angle);
      r.x.emplace_back(radius * std::cos(angle), -0.01 * i, -radius * std::sin(angle));
    }
  for (int i = 0; i < kAcross; ++i)
    for (int k = 0; k < kRound; ++k) {
      const int a = i * kRound + k, b = i * kRound + (k + 1) % kRound;
      r.triangles.push_back({a, b, a + kRound});
      r.triangles.push_back({b, b + kRound, a + kRound});
    }
  return r;
}

double area(double outer) { return std::numbers::pi * (outer * outer - 0.09 * 0.09); }

void expect_area(const char* what, double expected, const Ring& r) {
  const double ours = shadow_area_beyond(0.09, r.x, r.triangles);
  std::printf("%s: %.3f cm2, reference %.3f\n", what, 1e4 * ours, 1e4 * expected);
  EXPECT_NEAR(ours, expected, 1e-3 * area(0.15)) << what;
}

}  // namespace

TEST(Shadow, AreaIsTheProjectionsUnion) {
  expect_area("flat", area(0.15), ring([](double radius, double) { return radius; }));
  expect_area("cone", area(0.12), ring([](double radius, double) { return 0.09 + 0.5 * (radius - 0.09); }));
  // Out to 120 mm and back in: twice the cloth, one shadow.
  expect_area("folded back", area(0.12), ring([](double radius, double) { return 0.12 - std::abs(radius - 0.12); }));
}

TEST(Shadow, FlowerHasItsPetals) {
  for (const int petals : {3, 8}) {
    const Ring flower = ring([&](double radius, double angle) {
      return 0.09 + (radius - 0.09) * (0.6 + 0.2 * std::cos(petals * angle + 0.3));
    });
    const std::vector<double> outline = shadow_outline(0.09, flower.x, flower.triangles, 720);
    const std::vector<double> amplitude = harmonics(outline, 12);
    EXPECT_NEAR(amplitude[0], 0.09 + 0.06 * 0.6, 1e-5);
    for (int k = 1; k <= 12; ++k) EXPECT_NEAR(amplitude[k], k == petals ? 0.06 * 0.2 : 0, 2e-5) << k;
    EXPECT_EQ(node_count(outline, 0.003), petals);
    EXPECT_EQ(node_count(outline, 0.025), 0) << "no fold stands out so far";
  }
  const Ring round = ring([](double radius, double) { return radius; });
  EXPECT_EQ(node_count(shadow_outline(0.09, round.x, round.triangles, 720), 0.003), 0);
}
