#include "engine/terms/attachment.h"

#include "engine/geometry/rotation.h"

#include <Eigen/Eigenvalues>

namespace toile {

namespace {

using Jacobian = Eigen::Matrix<double, 3, 15>;

Jacobian jacobian(const AttachmentStencil& s, const AttachmentState& at) {
  Jacobian j;
  for (int i = 0; i < 3; ++i) j.block<3, 3>(0, 3 * i) = -s.weights[i] * Mat3::Identity();
  j.block<3, 3>(0, 9) = Mat3::Identity();
  j.block<3, 3>(0, 12) = -cross_matrix(at.lever) / at.gyration;
  return j;
}

Mat3 lever_under_load(const AttachmentStencil& s, const AttachmentState& at) {
  const Mat3 both = at.lever * at.stretch.transpose();
  return s.stiffness / (at.gyration * at.gyration) *
         (0.5 * (both + both.transpose()) - at.lever.dot(at.stretch) * Mat3::Identity());
}

Vec3 stretch_rate(const AttachmentStencil& s, const AttachmentState& at, const StencilPoints<5>& v) {
  Vec3 rate = v[3] + v[4].cross(at.lever) / at.gyration;
  for (int i = 0; i < 3; ++i) rate -= s.weights[i] * v[i];
  return rate;
}

}  // namespace

AttachmentState attachment_state(const AttachmentStencil& s, const StencilPoints<4>& x, const Mat3& orientation,
                                 double gyration) {
  AttachmentState at{orientation * s.point, Vec3::Zero(), gyration};
  at.stretch = x[3] + at.lever;
  for (int i = 0; i < 3; ++i) at.stretch -= s.weights[i] * x[i];
  return at;
}

double attachment_energy(const AttachmentStencil& s, const AttachmentState& at) {
  return 0.5 * s.stiffness * at.stretch.squaredNorm();
}

StencilVector<5> attachment_gradient(const AttachmentStencil& s, const AttachmentState& at) {
  return s.stiffness * jacobian(s, at).transpose() * at.stretch;
}

StencilMatrix<5> attachment_hessian(const AttachmentStencil& s, const AttachmentState& at) {
  const Jacobian j = jacobian(s, at);
  StencilMatrix<5> h = s.stiffness * j.transpose() * j;
  h.block<3, 3>(12, 12) += lever_under_load(s, at);
  return h;
}

StencilMatrix<5> attachment_hessian_psd(const AttachmentStencil& s, const AttachmentState& at) {
  const Jacobian j = jacobian(s, at);
  StencilMatrix<5> h = s.stiffness * j.transpose() * j;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(lever_under_load(s, at));
  h.block<3, 3>(12, 12) +=
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  return h;
}

double attachment_dissipation(const AttachmentStencil& s, const AttachmentState& at, const StencilPoints<5>& v) {
  return 0.5 * s.damping * s.stiffness * stretch_rate(s, at, v).squaredNorm();
}

StencilVector<5> attachment_dissipation_gradient(const AttachmentStencil& s, const AttachmentState& at,
                                                 const StencilPoints<5>& v) {
  return s.damping * s.stiffness * jacobian(s, at).transpose() * stretch_rate(s, at, v);
}

StencilMatrix<5> attachment_dissipation_hessian(const AttachmentStencil& s, const AttachmentState& at) {
  const Jacobian j = jacobian(s, at);
  return s.damping * s.stiffness * j.transpose() * j;
}

}  // namespace toile
