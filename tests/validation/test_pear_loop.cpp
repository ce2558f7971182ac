// The pear loop against the elastica: half a loop is integrated from the clamp, and two shots, the clamp's curvature
// and the level force, must bring it to the middle plane, running level.

#include "engine/experiments/pear_loop.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/pear_elastica.h"
#include "tests/validation/silent.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace toile;
using namespace toile::test;

TEST(PearLoop, ElasticaIsPeircesWithoutWeight) {
  const double ours = PearElastica(0).height();
  std::printf("weightless: height %.4f of the length, Peirce 1930: 0.4243\n", ours);
  EXPECT_NEAR(ours, 0.4243, 5e-4);
}

TEST(PearLoop, SaysWhereItTellsNothingOfTheStiffness) {
  Silent monitor;
  const auto report_at = [&](double weight, double stretch) {
    Fabric fabric = isotropic_fabric(0.2, stretch, 0.5 * stretch, 0, 0.2 * kGravity * std::pow(0.15, 3) / weight);
    fabric.thickness = 2e-5;
    return hang_loop({fabric, Direction::warp, 0.15, 0.015, 0.005}, 1, monitor).drape.report;
  };
  const auto says = [](const Report& report) {
    return std::any_of(report.warnings.begin(), report.warnings.end(),
                       [](const std::string& w) { return w.rfind("stiff_loop", 0) == 0; });
  };
  EXPECT_TRUE(says(report_at(5, 1000)));
  EXPECT_FALSE(says(report_at(300, 1000)));
  // Bending so stiff beside the membrane that the strip would rather shrink.
  const Report squeezed = report_at(6.6, 10);
  EXPECT_NE(squeezed.status, "converged") << squeezed.compressed_share;
}

TEST(PearLoop, HeightIsTheElasticas) {
  Silent monitor;
  for (const auto& [direction, stiffness] : {std::pair{Direction::warp, 40e-6}, {Direction::weft, 20e-6}}) {
    Fabric fabric = isotropic_fabric(0.2, 1000, 500, 0, 0);
    fabric.bending_stiffness = {40e-6, 20e-6, 30e-6};
    fabric.thickness = 2e-4;
    const double weight = 0.2 * kGravity * std::pow(0.15, 3) / stiffness;
    const double expected = 0.15 * PearElastica(weight).height();
    const PearLoopResult ours = hang_loop({fabric, direction}, 1, monitor);
    std::printf("weight %.0f D/L2: height %.2f mm, reference %.2f mm, weightless %.2f mm, error %.2f %%\n", weight,
                1e3 * ours.report.height, 1e3 * expected, 63.65, 100 * (ours.report.height / expected - 1));
    EXPECT_NEAR(ours.report.height, expected, 0.005 * expected);
    EXPECT_EQ(ours.drape.report.status, "converged");
  }
}
