#include "engine/terms/bending.h"

#include "engine/geometry/dihedral.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>

namespace toile {

namespace {

/// A steeper angle gradient [1/m] belongs to a hinge with a triangle under 1 µm high: its direction is noise, and its
/// square would leave single precision.
constexpr double kSteepest = 1e6;

/// Places of hinge i's four points (edge's start, end, inner tip, outer tip) in the stencil.
constexpr std::array<std::array<int, 4>, 3> kHinge = {{{1, 2, 0, 3}, {2, 0, 1, 4}, {0, 1, 2, 5}}};

StencilPoints<4> points_of(const StencilPoints<6>& x, int hinge) {
  const auto& at = kHinge[hinge];
  return {x[at[0]], x[at[1]], x[at[2]], x[at[3]]};
}

/// θ − θ₀ of the hinges and their gradients; zero where there is none.
struct Angles {
  Vec3 bent = Vec3::Zero();
  std::array<Vec12, 3> gradient;
};

/// An angle's difference in [−π, π], continuous where a fold at rest near ±180° is pressed through it.
double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// `robust`: hinges that have collapsed count as if they were not there.
Angles angles_of(const BendingStencil& s, const StencilPoints<6>& x, bool robust) {
  Angles a;
  for (int i = 0; i < 3; ++i) {
    a.gradient[i].setZero();
    if (!s.hinge[i]) continue;
    const StencilPoints<4> p = points_of(x, i);
    const Vec12 g = dihedral_angle_gradient(p[0], p[1], p[2], p[3]);
    if (robust && !(g.squaredNorm() < kSteepest * kSteepest)) continue;
    a.gradient[i] = g;
    a.bent[i] = wrapped(dihedral_angle(p[0], p[1], p[2], p[3]) - s.rest_angle[i]);
  }
  return a;
}

Vec3 rates_of(const Angles& a, const StencilPoints<6>& v) {
  Vec3 rate = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) rate[i] += a.gradient[i].segment<3>(3 * k).dot(v[kHinge[i][k]]);
  return rate;
}

using AngleGradients = Eigen::Matrix<double, 3, 18>;

AngleGradients stacked(const Angles& a) {
  AngleGradients g = AngleGradients::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) g.block<1, 3>(i, 3 * kHinge[i][k]) += a.gradient[i].segment<3>(3 * k).transpose();
  return g;
}

Mat3 stiffness_of(const BendingStencil& s) { return s.factor.transpose() * s.factor; }

bool bends_linearly(const BendingLaw* law) { return !law || law->linear(); }

/// ∂E/∂θ [N·m].
Vec3 elastic_moment(const BendingStencil& s, const BendingLaw* law, const Vec3& bent) {
  if (bends_linearly(law)) return s.factor.transpose() * (s.factor * bent);
  return law->area * law->fit.transpose() * law_moment(*law, law->fit * bent);
}

/// Lᵀ of a symmetric positive semi-definite matrix L Lᵀ.
Mat3 upper_factor(const Mat3& m) { return Eigen::LLT<Mat3>(m).matrixU(); }

}  // namespace

double bending_energy(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x) {
  const Vec3 bent = angles_of(s, x, false).bent;
  if (bends_linearly(law)) return 0.5 * (s.factor * bent).squaredNorm();
  return law->area * law_energy(*law, law->fit * bent);
}

StencilVector<6> bending_gradient(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x) {
  const Angles a = angles_of(s, x, false);
  return stacked(a).transpose() * elastic_moment(s, law, a.bent);
}

StencilMatrix<6> bending_hessian(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x) {
  const Angles a = angles_of(s, x, false);
  const Mat3 tangent = bends_linearly(law)
                           ? stiffness_of(s)
                           : Mat3(law->area * law->fit.transpose() * law_tangent(*law, law->fit * a.bent) * law->fit);
  const Vec3 moment = elastic_moment(s, law, a.bent);
  const AngleGradients g = stacked(a);
  StencilMatrix<6> hessian = g.transpose() * tangent * g;
  for (int i = 0; i < 3; ++i) {
    if (!s.hinge[i]) continue;
    const StencilPoints<4> p = points_of(x, i);
    const Mat12 second = moment[i] * dihedral_angle_hessian(p[0], p[1], p[2], p[3]);
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < 4; ++l)
        hessian.block<3, 3>(3 * kHinge[i][k], 3 * kHinge[i][l]) += second.block<3, 3>(3 * k, 3 * l);
  }
  return hessian;
}

StencilMatrix<6> bending_hessian_psd(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x) {
  const Angles a = angles_of(s, x, false);
  const AngleGradients g = stacked(a);
  if (bends_linearly(law)) return g.transpose() * stiffness_of(s) * g;
  return g.transpose() * (law->area * law->fit.transpose() * law_secant(*law, law->fit * a.bent) * law->fit) * g;
}

double bending_dissipation(const BendingStencil& s, const StencilPoints<6>& x, const StencilPoints<6>& v) {
  return 0.5 * s.damping * (s.factor * rates_of(angles_of(s, x, false), v)).squaredNorm();
}

StencilVector<6> bending_dissipation_gradient(const BendingStencil& s, const StencilPoints<6>& x,
                                              const StencilPoints<6>& v) {
  const Angles a = angles_of(s, x, false);
  return s.damping * stacked(a).transpose() * (stiffness_of(s) * rates_of(a, v));
}

StencilMatrix<6> bending_dissipation_hessian(const BendingStencil& s, const StencilPoints<6>& x) {
  return s.damping * bending_hessian_psd(s, nullptr, x);
}

Vec3 bending_curvature(const BendingStencil& s, const BendingLaw& law, const StencilPoints<6>& x) {
  return law.fit * angles_of(s, x, true).bent;
}

Eigen::Matrix<double, 18, 3> bending_friction_arm(const BendingStencil& s, const BendingLaw& law,
                                                  const StencilPoints<6>& x) {
  if (!(law.onset > 0)) return Eigen::Matrix<double, 18, 3>::Zero();
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(law.friction);
  const Mat3 root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                    eigen.eigenvectors().transpose();
  return -law.area * stacked(angles_of(s, x, true)).transpose() * law.fit.transpose() * root;
}

std::array<Vec3, 6> bending_force(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x,
                                  const StencilPoints<6>& v, double fabric_factor) {
  const Angles a = angles_of(s, x, true);
  const Vec3 moment =
      fabric_factor * (elastic_moment(s, law, a.bent) + s.damping * s.factor.transpose() * (s.factor * rates_of(a, v)));
  std::array<Vec3, 6> force;
  force.fill(Vec3::Zero());
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) force[kHinge[i][k]] -= moment[i] * a.gradient[i].segment<3>(3 * k);
  return force;
}

void bending_response(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x,
                      const StencilPoints<6>& v, const SystemWeights& weights, BendingResponse& out) {
  const Angles a = angles_of(s, x, true);
  const Vec3 damped = s.damping * s.factor.transpose() * (s.factor * rates_of(a, v));
  const Vec3 moment = weights.fabric * (elastic_moment(s, law, a.bent) + damped);
  out.force.fill(Vec3::Zero());
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) out.force[kHinge[i][k]] -= moment[i] * a.gradient[i].segment<3>(3 * k);

  Mat3 factor;
  if (bends_linearly(law)) {
    factor = std::sqrt(weights.fabric * (weights.stiffness + weights.dissipation * s.damping)) * s.factor;
  } else {
    const Mat3 total =
        weights.stiffness * law_secant(*law, law->fit * a.bent) + weights.dissipation * s.damping * law->stiffness;
    factor = std::sqrt(weights.fabric * law->area) * upper_factor(total) * law->fit;
  }
  for (auto& rows : out.rows) rows.setZero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k)
      out.rows[kHinge[i][k]] += (factor.col(i) * a.gradient[i].segment<3>(3 * k).transpose()).cast<float>();
}

}  // namespace toile
