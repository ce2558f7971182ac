#pragma once
// The one checker that every term's derivatives pass: finite differences, symmetry, definiteness, rigid motion.

#include "engine/terms/stencil.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace toile::test {

/// A potential over N nodes: energy over positions, or a dissipation over velocities.
template <int N>
struct Potential {
  std::function<double(const StencilPoints<N>&)> energy;
  std::function<StencilVector<N>(const StencilPoints<N>&)> gradient;
  std::function<StencilMatrix<N>(const StencilPoints<N>&)> hessian;
  std::function<StencilMatrix<N>(const StencilPoints<N>&)> hessian_psd = nullptr;
};

template <int N>
StencilVector<N> stacked(const StencilPoints<N>& x) {
  StencilVector<N> s;
  for (int i = 0; i < N; ++i) s.template segment<3>(3 * i) = x[i];
  return s;
}

template <int N>
StencilPoints<N> unstacked(const StencilVector<N>& s) {
  StencilPoints<N> x;
  for (int i = 0; i < N; ++i) x[i] = s.template segment<3>(3 * i);
  return x;
}

/// Derivative of f at 0 by Ridders' method: central differences at shrinking steps, extrapolated to zero, the entry
/// with the smallest error estimate wins. Good to about 1e-9 for smooth f, where plain differences stop at 1e-7.
template <class Value, class Function>
Value ridders(const Function& f, double step) {
  constexpr int kLevels = 9;
  constexpr double kShrink = 1.6;
  std::array<Value, kLevels> row, previous;
  Value best = (f(step) - f(-step)) / (2 * step);
  previous[0] = best;
  double best_error = std::numeric_limits<double>::infinity();
  const auto size = [](const Value& v) {
    if constexpr (std::is_same_v<Value, double>)
      return std::abs(v);
    else
      return v.norm();
  };
  for (int level = 1; level < kLevels; ++level) {
    step /= kShrink;
    row[0] = (f(step) - f(-step)) / (2 * step);
    double factor = kShrink * kShrink;
    for (int k = 1; k <= level; ++k, factor *= kShrink * kShrink) {
      row[k] = (row[k - 1] * factor - previous[k - 1]) / (factor - 1);
      const double error = std::max(size(row[k] - row[k - 1]), size(row[k] - previous[k - 1]));
      if (error <= best_error) {
        best_error = error;
        best = row[k];
      }
    }
    previous = row;
  }
  return best;
}

/// Of a symmetric matrix of any size; one for all stencils, because Eigen's solver takes seconds to compile for each.
Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric);

/// Gradient against the energy and Hessian against the gradient, both to 1e-6 relative; symmetry; definiteness of
/// hessian_psd. `feature` is the smallest length over which the potential changes [m]: differences start at a tenth of
/// it.
template <int N>
void check_derivatives(const Potential<N>& p, const StencilPoints<N>& at, double feature, const std::string& what) {
  const StencilVector<N> x = stacked<N>(at);
  const StencilVector<N> gradient = p.gradient(at);
  const StencilMatrix<N> hessian = p.hessian(at);
  ASSERT_TRUE(gradient.allFinite() && hessian.allFinite()) << what;
  StencilVector<N> gradient_fd;
  StencilMatrix<N> hessian_fd;
  const double step = 0.1 * feature;
  for (int k = 0; k < 3 * N; ++k) {
    const auto moved = [&](double t) { return unstacked<N>(x + t * StencilVector<N>::Unit(k)); };
    gradient_fd[k] = ridders<double>([&](double t) { return p.energy(moved(t)); }, step);
    hessian_fd.col(k) = ridders<StencilVector<N>>([&](double t) { return p.gradient(moved(t)); }, step);
  }
  // Where the gradient vanishes the measure is what it becomes a step away.
  EXPECT_LT((gradient - gradient_fd).norm(), 1e-6 * (gradient.norm() + hessian.norm() * step)) << what;
  EXPECT_LT((hessian - hessian_fd).norm(), 1e-6 * (hessian.norm() + gradient.norm() / step)) << what;
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-9 * hessian.norm() + 1e-300) << what;
  if (p.hessian_psd) {
    const StencilMatrix<N> psd = p.hessian_psd(at);
    EXPECT_LT((psd - psd.transpose()).norm(), 1e-9 * psd.norm() + 1e-300) << what;
    const Eigen::VectorXd eigenvalues = eigenvalues_of(0.5 * (psd + psd.transpose()));
    EXPECT_GT(eigenvalues.minCoeff(), -1e-10 * eigenvalues.cwiseAbs().maxCoeff() - 1e-300) << what;
  }
}

inline Mat3 random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

/// Energy does not change, the gradient turns along, net force and net torque are zero.
template <int N>
void check_rigid_motion(const Potential<N>& p, const StencilPoints<N>& at, const std::string& what) {
  std::mt19937 random(7);
  const Mat3 rotation = random_rotation(random);
  const Vec3 shift(0.3, -0.2, 0.5);
  StencilPoints<N> moved;
  for (int i = 0; i < N; ++i) moved[i] = rotation * at[i] + shift;
  const StencilVector<N> before = p.gradient(at), after = p.gradient(moved);
  // Rounding of the moved points counts with the potential's own stiffness.
  const double rounding = 1e-15 * p.hessian(at).norm();
  EXPECT_NEAR(p.energy(moved), p.energy(at), 1e-9 * std::abs(p.energy(at)) + rounding * before.norm() + 1e-28) << what;
  StencilVector<N> turned;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (int i = 0; i < N; ++i) {
    const Vec3 f = before.template segment<3>(3 * i);
    turned.template segment<3>(3 * i) = rotation * f;
    force += f;
    torque += (at[i] - at[0]).cross(f);
  }
  double size = 0;
  for (int i = 0; i < N; ++i) size = std::max(size, (at[i] - at[0]).norm());
  EXPECT_LT((after - turned).norm(), 1e-8 * before.norm() + 10 * rounding) << what;
  EXPECT_LT(force.norm(), 1e-10 * before.norm() + rounding) << what;
  EXPECT_LT(torque.norm(), 1e-10 * before.norm() * size + rounding) << what;
}

/// Everything, for a potential of shape alone.
template <int N>
void check_term(const Potential<N>& p, const StencilPoints<N>& at, double feature, const std::string& what) {
  check_derivatives<N>(p, at, feature, what);
  check_rigid_motion<N>(p, at, what);
}

/// Points with independent normal coordinates of the given spread about `center`.
template <int N>
StencilPoints<N> perturbed(const StencilPoints<N>& center, double spread, std::mt19937& random) {
  std::normal_distribution<double> normal(0, spread);
  StencilPoints<N> x = center;
  for (Vec3& p : x)
    for (int k = 0; k < 3; ++k) p[k] += normal(random);
  return x;
}

}  // namespace toile::test
