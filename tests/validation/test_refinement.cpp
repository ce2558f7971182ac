// How a drape settles as its mesh becomes finer, and whether the report's estimate of the discretisation error says so:
// the coarse lengths of tests/benchmark/refinement_study.cpp, which has the fine ones.

#include "engine/drape.h"
#include "engine/quality/distance_between.h"
#include "tests/validation/refinement_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

using namespace toile;
using namespace toile::test;

namespace {

Drape draped(const RefinementScene& study, double edge_length) {
  CountingMonitor monitor;
  return drape(study.at(edge_length), monitor);
}

/// The estimate is of the distance to the drape of no edge length, for which the finest stands.
void expect_estimate_within_a_factor_of_two(const RefinementScene& study, const std::vector<double>& coarse_lengths,
                                            double finest_length) {
  const Drape finest = draped(study, finest_length);
  ASSERT_EQ(finest.report.status, "converged");
  double before = 0, length_before = 0;
  for (const double h : coarse_lengths) {
    const Drape coarse = draped(study, h);
    ASSERT_EQ(coarse.report.status, "converged");
    const double distance =
        surface_distance(coarse.cloth.x, coarse.cloth.triangles, finest.cloth.x, finest.cloth.triangles).mean;
    const double estimate = coarse.report.discretisation_error;
    std::cout << study.name << ", " << 1e3 * h << " mm: distance to " << 1e3 * finest_length << " mm " << 1e3 * distance
              << " mm, estimate " << 1e3 * estimate << " mm, ratio " << estimate / distance;
    if (before > 0) std::cout << ", order " << std::log(before / distance) / std::log(length_before / h);
    std::cout << "\n";
    EXPECT_GT(estimate, 0.5 * distance);
    EXPECT_LT(estimate, 2 * distance);
    if (before > 0) {
      EXPECT_LT(distance, before);
    }
    before = distance;
    length_before = h;
  }
}

}  // namespace

TEST(RefinementReference, TableEdge) {
  expect_estimate_within_a_factor_of_two(table_edge_refinement(), {0.020, 0.014, 0.010}, 0.007);
}

/// On which the estimate was calibrated.
TEST(RefinementReference, Sphere) {
  expect_estimate_within_a_factor_of_two(sphere_refinement(), {0.020, 0.014, 0.010}, 0.007);
}

TEST(RefinementReference, Cone) {
  expect_estimate_within_a_factor_of_two(cone_refinement(), {0.020, 0.014, 0.010}, 0.007);
}

TEST(RefinementReference, Body) { expect_estimate_within_a_factor_of_two(body_refinement(), {0.020, 0.014}, 0.010); }
