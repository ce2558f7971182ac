#include "engine/linear/conjugate_gradient.h"

#include "engine/parallel/reduce.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr int kRowsPerTask = 1024;
constexpr int kContactsPerTask = 2048;

Eigen::Map<const Eigen::Vector3f> vec(const Float4& f) { return Eigen::Map<const Eigen::Vector3f>(&f.x); }
Eigen::Map<Eigen::Vector3f> vec(Float4& f) { return Eigen::Map<Eigen::Vector3f>(&f.x); }
double dot(const Float4& a, const Float4& b) {
  return double(a.x) * double(b.x) + double(a.y) * double(b.y) + double(a.z) * double(b.z);
}

}  // namespace

void BlockJacobi::set(int row, const Eigen::Matrix3f& diagonal_block) {
  const Mat3 symmetric = 0.5 * (diagonal_block + diagonal_block.transpose()).cast<double>();
  inverse_[row] = symmetric.inverse().cast<float>();
}

CgOutcome ConjugateGradient::solve(const BlockMatrix& fixed, ContactMatrix& dynamic, const BlockJacobi& preconditioner,
                                   const NodeVector& b, double tolerance, int most_iterations, NodeVector& x,
                                   std::span<RankOneMatrix* const> wide) {
  const int rows = fixed.rows();
  x.resize(rows);
  residual_.resize(rows);
  preconditioned_.resize(rows);
  product_.resize(rows);
  direction_.assign(rows, Float4{});
  const auto multiply = [&](int begin, int end, const NodeVector& v) {
    fixed.multiply_rows(begin, end, v, product_);
    if (dynamic.size() > 0) dynamic.multiply_add_rows(begin, end, product_);
    for (const RankOneMatrix* w : wide) w->multiply_add_rows(begin, end, product_);
  };
  const auto gather = [&](const NodeVector& v) {
    parallel_ranges(dynamic.size(), kContactsPerTask, [&](int begin, int end) { dynamic.gather(begin, end, v); });
    for (RankOneMatrix* w : wide) w->gather(v);
  };

  parallel_for_each(rows, 2 * kRowsPerTask, [&](int i) {
    if (preconditioner.held(i)) x[i] = Float4{};
  });
  gather(x);
  const auto start = deterministic_sums<2>(rows, kRowsPerTask, [&](int begin, int end) {
    std::array<double, 2> sums{};
    multiply(begin, end, x);
    for (int i = begin; i < end; ++i) {
      residual_[i] = Float4{};
      if (preconditioner.held(i)) continue;
      vec(residual_[i]) = vec(b[i]) - vec(product_[i]);
      sums[0] += dot(b[i], b[i]);
      sums[1] += dot(residual_[i], residual_[i]);
    }
    return sums;
  });
  const double norm2 = start[0];
  CgOutcome outcome;
  const bool solvable = norm2 > 0 && std::isfinite(norm2);
  const bool good_guess = solvable && start[1] < norm2;
  if (!good_guess) std::fill(x.begin(), x.end(), Float4{});
  if (!solvable) return outcome;
  outcome.relative_residual = good_guess ? std::sqrt(start[1] / norm2) : 1;
  if (outcome.relative_residual < tolerance) return outcome;

  double beta = 0;
  double rz = deterministic_sum(rows, kRowsPerTask, [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      if (!good_guess) residual_[i] = preconditioner.held(i) ? Float4{} : b[i];
      vec(preconditioned_[i]) = preconditioner.inverse(i) * vec(residual_[i]);
      sum += dot(residual_[i], preconditioned_[i]);
    }
    return sum;
  });
  while (outcome.iterations < most_iterations) {
    parallel_ranges(rows, 2 * kRowsPerTask, [&](int begin, int end) {
      const float factor = static_cast<float>(beta);
      for (int i = begin; i < end; ++i) vec(direction_[i]) = vec(preconditioned_[i]) + factor * vec(direction_[i]);
    });
    gather(direction_);
    const double curvature = deterministic_sum(rows, kRowsPerTask, [&](int begin, int end) {
      multiply(begin, end, direction_);
      double sum = 0;
      for (int i = begin; i < end; ++i) sum += dot(direction_[i], product_[i]);
      return sum;
    });
    if (!(curvature > 0)) break;
    const float alpha = static_cast<float>(rz / curvature);
    const auto sums = deterministic_sums<2>(rows, kRowsPerTask, [&](int begin, int end) {
      std::array<double, 2> partial{};
      for (int i = begin; i < end; ++i) {
        if (preconditioner.held(i)) continue;
        vec(x[i]) += alpha * vec(direction_[i]);
        vec(residual_[i]) -= alpha * vec(product_[i]);
        vec(preconditioned_[i]) = preconditioner.inverse(i) * vec(residual_[i]);
        partial[0] += dot(residual_[i], residual_[i]);
        partial[1] += dot(residual_[i], preconditioned_[i]);
      }
      return partial;
    });
    ++outcome.iterations;
    outcome.relative_residual = std::sqrt(sums[0] / norm2);
    if (outcome.relative_residual < tolerance) break;
    beta = sums[1] / rz;
    rz = sums[1];
  }
  return outcome;
}

}  // namespace toile
