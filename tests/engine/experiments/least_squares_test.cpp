// Least squares over costly, noisy residuals: known answers, places where nothing can be evaluated, bounds, standard
// errors.

#include "engine/experiments/least_squares.h"

#include <gmock/gmock.h>

#include <cmath>

using namespace toile;

namespace {

/// y = a exp(−b t) at t = 0, 0.5, … 4, over the logarithms of a and b, with an uncertainty of 1 %.
struct Decay {
  double a = 3, b = 0.8, noise = 0;
  int asked = 0;

  static double time(Eigen::Index k) { return 0.5 * static_cast<double>(k); }
  std::optional<Numbers> residual(const Numbers& p) {
    ++asked;
    Numbers r(9);
    for (Eigen::Index k = 0; k < r.size(); ++k) {
      const double fitted = std::exp(p[0] - std::exp(p[1]) * time(k)), measured = a * std::exp(-b * time(k));
      r[k] = (std::log(fitted / measured) + noise * std::sin(1e6 * (p[0] + 3 * p[1]) + static_cast<double>(k))) / 0.01;
    }
    return r;
  }
  LeastSquaresProblem problem(double start_a, double start_b) {
    LeastSquaresProblem problem;
    problem.start.resize(2);
    problem.start << std::log(start_a), std::log(start_b);
    problem.low = Numbers::Constant(2, -5);
    problem.high = Numbers::Constant(2, 5);
    problem.step = Numbers::Constant(2, 0.02);
    problem.residuals = 9;
    problem.evaluate = [this](const std::vector<Numbers>& points) {
      std::vector<std::optional<Numbers>> found;
      for (const Numbers& p : points) found.push_back(residual(p));
      return found;
    };
    return problem;
  }
};

}  // namespace

TEST(LeastSquares, FindsTheAnswerFromFarAway) {
  Decay decay;
  const LeastSquaresSolution solution = least_squares(decay.problem(0.1, 5));
  EXPECT_TRUE(solution.converged);
  EXPECT_EQ(solution.stop_reason, "no_better");
  EXPECT_NEAR(std::exp(solution.parameters[0]), decay.a, 1e-3 * decay.a);
  EXPECT_NEAR(std::exp(solution.parameters[1]), decay.b, 1e-3 * decay.b);
}

TEST(LeastSquares, IsDoneAtOnceWhereItStartsAtTheAnswer) {
  Decay decay;
  const LeastSquaresSolution solution = least_squares(decay.problem(decay.a, decay.b));
  EXPECT_TRUE(solution.converged);
  EXPECT_LE(solution.iterations, 3);
}

TEST(LeastSquares, NoiseOfTheExperimentsIsNeitherFollowedNorChased) {
  Decay decay;
  decay.noise = 1e-4;
  const LeastSquaresSolution solution = least_squares(decay.problem(1, 2));
  EXPECT_TRUE(solution.converged);
  EXPECT_NEAR(std::exp(solution.parameters[0]), decay.a, 1e-3 * decay.a);
  EXPECT_NEAR(std::exp(solution.parameters[1]), decay.b, 1e-3 * decay.b);
  EXPECT_LT(decay.asked, 60);
}

TEST(LeastSquares, StepsToWhereNothingCanBeEvaluatedAreTakenBack) {
  Decay decay;
  LeastSquaresProblem problem = decay.problem(0.2, 0.2);
  const auto everywhere = problem.evaluate;
  problem.evaluate = [everywhere](const std::vector<Numbers>& points) {
    auto found = everywhere(points);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i][0] > std::log(3.3)) found[i].reset();
    return found;
  };
  const LeastSquaresSolution solution = least_squares(problem);
  EXPECT_TRUE(solution.converged);
  EXPECT_NEAR(std::exp(solution.parameters[0]), decay.a, 0.01 * decay.a);
  problem.start[0] = 2;
  EXPECT_EQ(least_squares(problem).stop_reason, "start_failed");
}

TEST(LeastSquares, AnAnswerOutOfBoundsEndsAtTheBound) {
  Decay decay;
  LeastSquaresProblem problem = decay.problem(1, 0.8);
  problem.high[0] = std::log(2);
  const LeastSquaresSolution solution = least_squares(problem);
  EXPECT_TRUE(solution.converged);
  EXPECT_NEAR(solution.parameters[0], std::log(2), 1e-9);
}

TEST(Determination, IsTheStandardErrorOfAStraightLine) {
  // y = p + q t at t = 0 … 4, uncertainty 1: variances 0.6 and 0.1.
  Eigen::MatrixXd jacobian(5, 2);
  for (int k = 0; k < 5; ++k) jacobian.row(k) << 1, k;
  const Determination exact = determination(jacobian, Numbers::Zero(5));
  EXPECT_NEAR(exact.standard_error[0], std::sqrt(0.6), 1e-12);
  EXPECT_NEAR(exact.standard_error[1], std::sqrt(0.1), 1e-12);
  EXPECT_GT(exact.singular_values[0], exact.singular_values[1]);
  // Residuals that scatter more than they should: chi² of 20 over 3 degrees of freedom.
  const Determination scattered = determination(jacobian, Numbers::Constant(5, 2));
  EXPECT_NEAR(scattered.standard_error[1], std::sqrt(0.1 * 20 / 3), 1e-12);
}

TEST(Determination, WhatNoReadingDependsOnIsUnknownAndTheRestIsNot) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, 2);
  jacobian.col(0).setConstant(10);
  const Determination result = determination(jacobian, Numbers::Zero(3));
  EXPECT_NEAR(result.standard_error[0], 0.1 / std::sqrt(3), 1e-6);
  EXPECT_TRUE(std::isinf(result.standard_error[1]));
  EXPECT_NEAR(result.singular_values[1], 0, 1e-12);
}
