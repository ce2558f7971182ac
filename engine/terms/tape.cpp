#include "engine/terms/tape.h"

namespace toile {

namespace {

constexpr double kShortest = 1e-6;  // [m]; a shorter segment has no direction to speak of

struct Segment {
  double length;
  Vec3 tangent;
  Mat3 across() const { return (Mat3::Identity() - tangent * tangent.transpose()) / length; }  ///< ∂t/∂(end)
};

Segment segment(const Vec3& from, const Vec3& to) {
  const double length = std::max((to - from).norm(), kShortest);
  return {length, (to - from) / length};
}

using Jacobian = Eigen::Matrix<double, 3, 9>;

Jacobian jacobian(const StencilPoints<3>& x) {
  const Mat3 first = segment(x[0], x[1]).across(), second = segment(x[1], x[2]).across();
  Jacobian j;
  j << first, -first - second, second;
  return j;
}

/// ∂²(t₁·t₂)/∂u² for u a segment with tangent t beside one with tangent o.
Mat3 turning(const Segment& u, const Vec3& o) {
  const double f = u.tangent.dot(o);
  const Mat3 both = u.tangent * o.transpose();
  return -(both + both.transpose() + f * (Mat3::Identity() - 3 * u.tangent * u.tangent.transpose())) /
         (u.length * u.length);
}

}  // namespace

double tape_energy(const TapeStencil& s, const StencilPoints<3>& x) {
  return 0.5 * s.bending / s.length * (segment(x[1], x[2]).tangent - segment(x[0], x[1]).tangent).squaredNorm();
}

StencilVector<3> tape_gradient(const TapeStencil& s, const StencilPoints<3>& x) {
  return s.bending / s.length * jacobian(x).transpose() * (segment(x[1], x[2]).tangent - segment(x[0], x[1]).tangent);
}

StencilMatrix<3> tape_hessian(const TapeStencil& s, const StencilPoints<3>& x) {
  // E = (B/l̄)(1 − t₁·t₂) over u = x₁ − x₀ and v = x₂ − x₁.
  const Segment u = segment(x[0], x[1]), v = segment(x[1], x[2]);
  const Mat3 uu = turning(u, v.tangent), vv = turning(v, u.tangent), uv = u.across() * v.across();
  StencilMatrix<3> h;
  h << uu, uv - uu, -uv,                                            //
      uv.transpose() - uu, uu + vv - uv - uv.transpose(), uv - vv,  //
      -uv.transpose(), uv.transpose() - vv, vv;
  return -s.bending / s.length * h;
}

StencilMatrix<3> tape_hessian_psd(const TapeStencil& s, const StencilPoints<3>& x) {
  const Jacobian j = jacobian(x);
  return s.bending / s.length * j.transpose() * j;
}

double tape_dissipation(const TapeStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v) {
  StencilVector<3> velocity;
  velocity << v[0], v[1], v[2];
  return 0.5 * s.damping * s.bending / s.length * (jacobian(x) * velocity).squaredNorm();
}

StencilVector<3> tape_dissipation_gradient(const TapeStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v) {
  StencilVector<3> velocity;
  velocity << v[0], v[1], v[2];
  const Jacobian j = jacobian(x);
  return s.damping * s.bending / s.length * j.transpose() * (j * velocity);
}

StencilMatrix<3> tape_dissipation_hessian(const TapeStencil& s, const StencilPoints<3>& x) {
  return s.damping * tape_hessian_psd(s, x);
}

}  // namespace toile
