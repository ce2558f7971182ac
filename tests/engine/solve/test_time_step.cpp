#include "engine/solve/relaxation.h"
#include "engine/solve/rest.h"
#include "engine/solve/time_step.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

using namespace toile;

TEST(TimeStep, StartsSmallUnderRelaxationAndGrowsAfterFiveSuccesses) {
  SolverOptions options;
  TimeStep step(options);
  EXPECT_DOUBLE_EQ(step.h(), 1e-3 / 16);
  for (int k = 0; k < 4; ++k) step.accepted();
  EXPECT_DOUBLE_EQ(step.h(), 1e-3 / 16);
  step.accepted();
  EXPECT_DOUBLE_EQ(step.h(), 1e-3 / 16 / 0.75);
  for (int k = 0; k < 200; ++k) step.accepted();
  EXPECT_DOUBLE_EQ(step.h(), 1e-3);
}

TEST(TimeStep, AFailureSplitsAndStartsTheCountAnew) {
  SolverOptions options;
  options.relaxation_time = 0;
  TimeStep step(options);
  EXPECT_DOUBLE_EQ(step.h(), 1e-3);
  step.rejected();
  EXPECT_DOUBLE_EQ(step.h(), 0.75e-3);
  for (int k = 0; k < 4; ++k) step.accepted();
  step.rejected();
  for (int k = 0; k < 4; ++k) step.accepted();
  EXPECT_DOUBLE_EQ(step.h(), 0.75 * 0.75e-3);
  EXPECT_EQ(step.splits(), 2);
  EXPECT_FALSE(step.too_small());
  for (int k = 0; k < 40; ++k) step.rejected();
  EXPECT_TRUE(step.too_small());
}

TEST(Relaxation, StiffnessRisesLinearlyInTheWindow) {
  SolverOptions options;
  EXPECT_DOUBLE_EQ(relaxation_factor(0, options), 1e-2);
  EXPECT_DOUBLE_EQ(relaxation_factor(0.05, options), 0.505);
  EXPECT_DOUBLE_EQ(relaxation_factor(0.1, options), 1);
  EXPECT_TRUE(relaxing(0.0999, options));
  EXPECT_FALSE(relaxing(0.1, options));
  options.relaxation_time = 0;
  EXPECT_DOUBLE_EQ(relaxation_factor(0, options), 1);
}

TEST(Rest, Percentile) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1.0);
  EXPECT_EQ(percentile_99(values), 990);
  EXPECT_EQ(percentile_99(std::vector<double>{3}), 3);
  EXPECT_EQ(percentile_99({}), 0);
}

TEST(Rest, NeedsTheWholeWindowBelowTheThreshold) {
  SolverOptions options;
  RestDetector rest(options);
  const std::vector<double> quiet(200, 0.5e-8);
  std::vector<double> one_moves = quiet, three_move = quiet;
  one_moves[7] = 1;
  three_move[7] = three_move[8] = three_move[9] = 1;
  for (int k = 0; k < 99; ++k) EXPECT_FALSE(rest.update(one_moves, 1e-3)) << k;
  EXPECT_FALSE(rest.update(three_move, 1e-3));
  for (int k = 0; k < 99; ++k) EXPECT_FALSE(rest.update(quiet, 1e-3)) << k;
  EXPECT_TRUE(rest.update(quiet, 1e-3));
  rest.reset();
  EXPECT_FALSE(rest.update(quiet, 1e-3));
}

TEST(DampingRelief, HalvesOnceAWindowWhileQuietAndOutOfBalance) {
  SolverOptions options;
  options.rest_window = 0.1;
  DampingRelief relief(options);
  const auto run = [&](int steps, bool quiet, bool balanced) {
    double factor = 0;
    for (int k = 0; k < steps; ++k) factor = relief.update(quiet, balanced, 0.01);
    return factor;
  };
  EXPECT_EQ(run(50, false, false), 1);
  EXPECT_EQ(run(9, true, false), 1);
  EXPECT_EQ(run(1, true, false), 0.5);
  EXPECT_EQ(run(10, true, false), 0.25);
  EXPECT_EQ(run(50, true, true), 0.25);  // in balance: as it is
  EXPECT_EQ(run(200, true, false), 1.0 / 64);
  EXPECT_EQ(run(1, false, false), 1);  // loud: all of it again
}
