#include "engine/terms/trim_contact.h"

#include "engine/geometry/rotation.h"

#include <Eigen/Eigenvalues>

namespace toile {

namespace {

using Jacobian = Eigen::Matrix<double, 3, 15>;

Jacobian jacobian(const TrimContact& c, const TrimContactState& at) {
  Jacobian j = Jacobian::Zero();
  for (int i = 0; i < c.contact.count; ++i) j.block<3, 3>(0, 3 * i) = c.contact.weights[i] * Mat3::Identity();
  j.block<3, 3>(0, 9) = c.side * Mat3::Identity();
  j.block<3, 3>(0, 12) = -c.side / at.gyration * cross_matrix(at.lever);
  return j;
}

Mat3 lever_under_load(const TrimContact& c, const TrimContactState& at, const Vec3& force) {
  const Mat3 both = at.lever * force.transpose();
  return -c.side / (at.gyration * at.gyration) *
         (0.5 * (both + both.transpose()) - at.lever.dot(force) * Mat3::Identity());
}

Mat3 positive_part(const Mat3& m) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(m);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

TrimContactState trim_contact_state(const TrimContact& c, const StencilPoints<3>& cloth, const Vec3& center,
                                    const Mat3& orientation, double gyration) {
  TrimContactState at{orientation * c.point, Vec3::Zero(), gyration};
  at.point = c.side * (center + at.lever);
  for (int i = 0; i < c.contact.count; ++i) at.point += c.contact.weights[i] * cloth[i];
  return at;
}

double trim_contact_energy(const TrimContact& c, double stiffness, const TrimContactState& at) {
  return contact_energy(c.contact, stiffness, at.point);
}

StencilVector<5> trim_contact_gradient(const TrimContact& c, double stiffness, const TrimContactState& at) {
  return -jacobian(c, at).transpose() * contact_response(c.contact, stiffness, at.point).force;
}

StencilMatrix<5> trim_contact_hessian(const TrimContact& c, double stiffness, const TrimContactState& at) {
  const Jacobian j = jacobian(c, at);
  const ContactResponse r = contact_response(c.contact, stiffness, at.point);
  StencilMatrix<5> h = j.transpose() * r.hessian * j;
  h.block<3, 3>(12, 12) += lever_under_load(c, at, r.force);
  return h;
}

StencilMatrix<5> trim_contact_hessian_psd(const TrimContact& c, double stiffness, const TrimContactState& at) {
  const TrimContactResponse r = trim_contact_response(c, stiffness, at);
  StencilMatrix<5> h = StencilMatrix<5>::Zero();
  for (const StencilVector<5>& row : r.rows) h += row * row.transpose();
  h.block<3, 3>(12, 12) += r.rotation;
  return h;
}

TrimContactResponse trim_contact_response(const TrimContact& c, double stiffness, const TrimContactState& at) {
  const ContactResponse r = contact_response(c.contact, stiffness, at.point);
  TrimContactResponse response;
  if (!(r.normal_force > 0)) return response;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(r.hessian);
  const Jacobian j = jacobian(c, at);
  response.force = j.transpose() * r.force;
  for (int k = 0; k < 3; ++k)
    response.rows[k] = std::sqrt(std::max(0.0, eigen.eigenvalues()[k])) * j.transpose() * eigen.eigenvectors().col(k);
  response.rotation = positive_part(lever_under_load(c, at, r.force));
  return response;
}

}  // namespace toile
