#include "engine/geometry/dihedral.h"

#include "engine/geometry/rotation.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>

namespace toile {

namespace {

/// A wing whose height over the shared edge is below this fraction of the edge has no normal that a double can hold.
constexpr double kLeastHeight = 1e-15;

/// One wing of the hinge: the gradient with respect to its tip and the foot of the tip on the edge.
struct Wing {
  Vec3 normal;     ///< N, twice the area long
  double squared;  ///< |N|²
  double foot;     ///< (tip − x0)·e / |e|²
  Vec3 gradient;   ///< −|e| N / |N|²
};

Wing make_wing(const Vec3& normal, const Vec3& tip, const Vec3& e, double length2) {
  const double squared = normal.squaredNorm();
  return {normal, squared, tip.dot(e) / length2, -std::sqrt(length2) / squared * normal};
}

struct Hinge {
  Vec3 e, u, v;  ///< x1 − x0, x2 − x0, x3 − x0
  double length2;
  Wing first, second;
};

/// Nothing for a hinge with a wing of no area: it has no angle.
std::optional<Hinge> make_hinge(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 e = x1 - x0, u = x2 - x0, v = x3 - x0, n1 = e.cross(u), n2 = v.cross(e);
  const double length2 = e.squaredNorm();
  const double least = std::max(kLeastHeight * kLeastHeight * length2 * length2, DBL_MIN);
  if (!(n1.squaredNorm() > least && n2.squaredNorm() > least)) return std::nullopt;
  return Hinge{e, u, v, length2, make_wing(n1, u, e, length2), make_wing(n2, v, e, length2)};
}

/// Derivatives of one wing's tip gradient and foot with respect to the edge and the tip (both relative to x0).
struct WingDerivative {
  Mat3 gradient_edge, gradient_tip;
  Vec3 foot_edge, foot_tip;
};

/// `side` is +1 for N = e × tip and −1 for N = tip × e.
WingDerivative differentiate(const Wing& wing, const Vec3& tip, const Vec3& e, double length2, double side) {
  const double length = std::sqrt(length2);
  const Mat3 reflect = Mat3::Identity() - 2 / wing.squared * wing.normal * wing.normal.transpose();
  const Mat3 gradient_normal = -length / wing.squared * reflect;
  WingDerivative d;
  d.gradient_edge =
      gradient_normal * (-side * cross_matrix(tip)) - wing.normal * e.transpose() / (wing.squared * length);
  d.gradient_tip = gradient_normal * (side * cross_matrix(e));
  d.foot_edge = (tip - 2 * wing.foot * e) / length2;
  d.foot_tip = e / length2;
  return d;
}

}  // namespace

double dihedral_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const Vec3 e = x1 - x0;
  const Vec3 n1 = e.cross(x2 - x0), n2 = (x3 - x0).cross(e);
  return std::atan2(e.dot(n1.cross(n2)), e.norm() * n1.dot(n2));
}

Vec12 dihedral_angle_gradient(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const std::optional<Hinge> hinge = make_hinge(x0, x1, x2, x3);
  if (!hinge) return Vec12::Zero();
  const Hinge& h = *hinge;
  Vec12 gradient;
  gradient.segment<3>(0) = -(1 - h.first.foot) * h.first.gradient - (1 - h.second.foot) * h.second.gradient;
  gradient.segment<3>(3) = -h.first.foot * h.first.gradient - h.second.foot * h.second.gradient;
  gradient.segment<3>(6) = h.first.gradient;
  gradient.segment<3>(9) = h.second.gradient;
  return gradient;
}

Mat12 dihedral_angle_hessian(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  const std::optional<Hinge> hinge = make_hinge(x0, x1, x2, x3);
  if (!hinge) return Mat12::Zero();
  const Hinge& h = *hinge;
  const WingDerivative d1 = differentiate(h.first, h.u, h.e, h.length2, 1);
  const WingDerivative d2 = differentiate(h.second, h.v, h.e, h.length2, -1);

  // With respect to (e, u, v), that is to (x1, x2, x3) while x0 stays; x0 follows from invariance under translation.
  Eigen::Matrix<double, 9, 9> relative;
  relative.setZero();
  relative.block<3, 3>(3, 0) = d1.gradient_edge;
  relative.block<3, 3>(3, 3) = d1.gradient_tip;
  relative.block<3, 3>(6, 0) = d2.gradient_edge;
  relative.block<3, 3>(6, 6) = d2.gradient_tip;
  relative.block<3, 3>(0, 0) = -h.first.gradient * d1.foot_edge.transpose() - h.first.foot * d1.gradient_edge -
                               h.second.gradient * d2.foot_edge.transpose() - h.second.foot * d2.gradient_edge;
  relative.block<3, 3>(0, 3) = -h.first.gradient * d1.foot_tip.transpose() - h.first.foot * d1.gradient_tip;
  relative.block<3, 3>(0, 6) = -h.second.gradient * d2.foot_tip.transpose() - h.second.foot * d2.gradient_tip;
  relative = (0.5 * (relative + relative.transpose())).eval();

  Mat12 hessian;
  hessian.bottomRightCorner<9, 9>() = relative;
  const Eigen::Matrix<double, 9, 3> columns =
      -(relative.leftCols<3>() + relative.middleCols<3>(3) + relative.rightCols<3>());
  hessian.bottomLeftCorner<9, 3>() = columns;
  hessian.topRightCorner<3, 9>() = columns.transpose();
  const Mat3 corner = -(columns.topRows<3>() + columns.middleRows<3>(3) + columns.bottomRows<3>());
  hessian.topLeftCorner<3, 3>() = 0.5 * (corner + corner.transpose());
  return hessian;
}

}  // namespace toile
