// How a drape settles as its mesh becomes finer, and whether the report's estimate of the discretisation error says so:
// the coarse lengths of tests/benchmark/refinement_study.cpp, which has the fine ones, the body, and the sphere on
// which the estimate was calibrated.

#include "engine/drape.h"
#include "engine/quality/distance_between.h"
#include "tests/validation/refinement_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

Drape draped(const RefinementScene& study, double edge_length) {
  CountingMonitor monitor;
  return drape(study.at(edge_length), monitor);
}

/// The estimate is of the distance to the drape of no edge length. 10 mm stand for it, which are off by about a quarter
/// of what 20 mm are.
void expect_estimate_within_a_factor_of_two(const RefinementScene& study) {
  const Drape finest = draped(study, 0.010);
  ASSERT_EQ(finest.report.status, "converged");
  double before = 0;
  for (const double h : {0.020, 0.014}) {
    const Drape coarse = draped(study, h);
    ASSERT_EQ(coarse.report.status, "converged");
    const double distance =
        surface_distance(coarse.cloth.x, coarse.cloth.triangles, finest.cloth.x, finest.cloth.triangles).mean;
    const double estimate = coarse.report.discretisation_error;
    std::cout << study.name << ", " << 1e3 * h << " mm: distance to 10 mm " << 1e3 * distance << " mm, estimate "
              << 1e3 * estimate << " mm, ratio " << estimate / distance;
    if (before > 0) std::cout << ", order " << std::log(before / distance) / std::log(0.020 / h);
    std::cout << "\n";
    EXPECT_GT(estimate, 0.5 * distance);
    EXPECT_LT(estimate, 2 * distance);
    if (before > 0) {
      EXPECT_LT(distance, before);
    }
    before = distance;
  }
}

}  // namespace

TEST(RefinementReference, TableEdge) { expect_estimate_within_a_factor_of_two(table_edge_refinement()); }

/// A smaller sheet than the study's, whose finest mesh slides for three seconds.
TEST(RefinementReference, Cone) {
  RefinementScene study = cone_refinement();
  study.scene.garments = {square_garment(0.24, 0.02, 0.003, canvas())};
  expect_estimate_within_a_factor_of_two(study);
}
