// Heavy strips clamped along their short edge, on the panel mesher's meshes, against the elastica.

#include "tests/validation/references.h"
#include "tests/validation/strip.h"

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kDensity = 0.2;  ///< [kg/m²]

/// The strip's tip over its length at Γ = ρ g L³/D, meshed with edges of L/cells.
Vec3 tip_at(double gamma, int cells, double degrees = 0) {
  StripScene scene;
  scene.edge = scene.length / cells;
  scene.degrees = degrees;
  const double d = bending_at(gamma, kDensity, scene.length);
  HeldCloth strip = make_strip(scene, strip_fabric(kDensity, {d, d, d}));
  EXPECT_LT(settle(strip).residual, 1e-3) << gamma;
  return tip_of(strip) / scene.length;
}

struct ElasticaTip {
  double x, drop;
};

ElasticaTip elastica(double gamma) {
  const std::string at = "/cantilever/" + std::to_string(reference_row("/cantilever", "Gamma", gamma));
  return {reference(at + "/x"), reference(at + "/drop")};
}

double error_of(const Vec3& tip, const ElasticaTip& exact) {
  return std::hypot(tip.x() - exact.x, -tip.y() - exact.drop);
}

}  // namespace

TEST(CantileverReference, TipIsWithinOnePerCentOfTheLength) {
  SKIP_WITHOUT_REFERENCES();
  for (double gamma : {0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    const ElasticaTip exact = elastica(gamma);
    const Vec3 tip = tip_at(gamma, 40);
    std::printf("Gamma %6g  x %.5f (%.5f)  drop %.5f (%.5f)  error %.2f %% of L\n", gamma, tip.x(), exact.x, -tip.y(),
                exact.drop, 100 * error_of(tip, exact));
    EXPECT_LT(error_of(tip, exact), 0.01) << gamma;
  }
}

TEST(CantileverReference, ErrorFallsWithTheEdgeLength) {
  SKIP_WITHOUT_REFERENCES();
  for (double gamma : {1.0, 10.0, 100.0}) {
    const ElasticaTip exact = elastica(gamma);
    double error[3];
    for (int k = 0; k < 3; ++k) error[k] = error_of(tip_at(gamma, 10 << k), exact);
    const double order = 0.5 * std::log2(error[0] / error[2]);
    std::printf("Gamma %6g  error %.3f %.3f %.3f %% of L at L/10, L/20, L/40  order %.2f\n", gamma, 100 * error[0],
                100 * error[1], 100 * error[2], order);
    EXPECT_GT(error[0], error[1]);
    EXPECT_GT(error[1], error[2]);
    EXPECT_GT(order, 1.5) << gamma;
    EXPECT_LT(error[2], 0.0015) << gamma;
  }
}

TEST(CantileverReference, PeircesAngle) {
  SKIP_WITHOUT_REFERENCES();
  const Vec3 tip = tip_at(8, 40);
  const double degrees = std::atan2(-tip.y(), tip.x()) * 180 / std::numbers::pi;
  std::printf("chord at c = l/2: %.2f degrees (41.49)\n", degrees);
  EXPECT_NEAR(degrees, 41.5, 0.5);
}

TEST(CantileverReference, StripCutAtAnyAngleDropsAsFar) {
  double least = 1, largest = 0;
  for (double degrees = 0; degrees <= 90; degrees += 15) {
    const double drop = -tip_at(8, 40, degrees).y();
    std::printf("cut at %2.0f degrees: drop %.4f L\n", degrees, drop);
    least = std::min(least, drop);
    largest = std::max(largest, drop);
  }
  std::printf("max/min %.4f\n", largest / least);
  EXPECT_LT(largest / least, 1.02);
}

TEST(CantileverReference, WarpAndWeftBendWithTheirOwnStiffness) {
  SKIP_WITHOUT_REFERENCES();
  const double d = bending_at(20, kDensity, StripScene{}.length);
  for (const auto& [degrees, gamma] : {std::pair{0.0, 20.0}, {90.0, 5.0}}) {
    StripScene scene;
    scene.degrees = degrees;
    HeldCloth strip = make_strip(scene, strip_fabric(kDensity, {4 * d, d, 2.5 * d}));
    settle(strip);
    const Vec3 tip = tip_of(strip) / scene.length;
    const ElasticaTip exact = elastica(gamma);
    std::printf("%s: x %.5f (%.5f)  drop %.5f (%.5f)\n", degrees == 0 ? "weft" : "warp", tip.x(), exact.x, -tip.y(),
                exact.drop);
    EXPECT_LT(error_of(tip, exact), 0.0015);
  }
}

TEST(CantileverReference, PinnedRowWithoutAClampIsAHinge) {
  StripScene scene;
  scene.edge = scene.length / 10;
  const double d = bending_at(1, kDensity, scene.length);
  Scene pinned = strip_scene(scene, strip_fabric(kDensity, {d, d, d}));
  pinned.garments[0].pins[0].clamp = false;
  HeldCloth strip = held_cloth(pinned);
  settle(strip);
  EXPECT_GT(-tip_of(strip).y(), 0.99 * scene.length);  // it hangs
}

TEST(UprightStrip, StandsBelowItsCriticalHeightAndFallsAbove) {
  SKIP_WITHOUT_REFERENCES();
  const double critical = reference("/upright_strip/Gamma_critical");
  for (double gamma : {7.0, 9.0}) {
    StripScene scene;
    scene.edge = scene.length / 20;
    scene.upright = true;
    scene.bow = 0.05;
    const double d = bending_at(gamma, kDensity, scene.length);
    HeldCloth strip = make_strip(scene, strip_fabric(kDensity, {d, d, d}));
    settle(strip);
    const Vec3 tip = tip_of(strip) / scene.length;
    std::printf("Gamma %g (critical %.3f): tip at height %.4f L, %.4f L aside\n", gamma, critical, tip.y(), tip.x());
    if (gamma < critical) {
      EXPECT_LT(std::abs(tip.x()), 0.01);
    } else {
      EXPECT_GT(std::abs(tip.x()), 0.3);
    }
  }
}
