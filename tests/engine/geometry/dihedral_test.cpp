#include "engine/geometry/dihedral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <type_traits>

namespace toile {
namespace {

using Hinge = std::array<Vec3, 4>;

Hinge moved(Hinge h, int coordinate, double by) {
  h[coordinate / 3][coordinate % 3] += by;
  return h;
}
double angle(const Hinge& h) { return dihedral_angle(h[0], h[1], h[2], h[3]); }
Vec12 gradient(const Hinge& h) { return dihedral_angle_gradient(h[0], h[1], h[2], h[3]); }
Mat12 hessian(const Hinge& h) { return dihedral_angle_hessian(h[0], h[1], h[2], h[3]); }

/// A hinge of edge 1 whose second wing is folded by `fold` [rad] out of the plane of the first, ridge positive.
Hinge folded(double fold, double height1 = 0.8, double height2 = 1.1) {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.4, height1, 0),
          Vec3(0.7, -height2 * std::cos(fold), -height2 * std::sin(fold))};
}

Hinge random_hinge(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1);
  Hinge h;
  for (Vec3& x : h) x = {place(random), place(random), place(random)};
  return h;
}

/// Fourth-order central differences: at h = 1e-3 of the smallest height, error about 1e-11 relative.
template <typename F>
std::invoke_result_t<F, const Hinge&> difference(F&& f, const Hinge& h, int i, double step) {
  return (8 * (f(moved(h, i, step)) - f(moved(h, i, -step))) - f(moved(h, i, 2 * step)) + f(moved(h, i, -2 * step))) /
         (12 * step);
}

/// Differences of an angle that may pass ±π.
double angle_difference(const Hinge& h, int i, double step) {
  const auto turn = [&](double by) { return std::remainder(angle(moved(h, i, by)) - angle(h), 2 * std::numbers::pi); };
  return (8 * (turn(step) - turn(-step)) - turn(2 * step) + turn(-2 * step)) / (12 * step);
}

void expect_derivatives(const Hinge& h, double step, double tolerance = 1e-6) {
  const Vec12 g = gradient(h);
  const Mat12 hess = hessian(h);
  Vec12 g_numeric;
  Mat12 h_numeric;
  for (int i = 0; i < 12; ++i) {
    g_numeric[i] = angle_difference(h, i, step);
    h_numeric.col(i) = difference([](const Hinge& x) -> Vec12 { return gradient(x); }, h, i, step);
  }
  EXPECT_LE((g - g_numeric).norm(), tolerance * g.norm());
  EXPECT_LE((hess - h_numeric).norm(), tolerance * hess.norm());
  EXPECT_EQ(hess, hess.transpose());
}

TEST(Dihedral, AngleIsTheFoldUpTo180Degrees) {
  for (double degrees : {0.0, 1e-9, 1e-3, 45.0, 90.0, 135.0, 179.0, 179.9, 179.999999}) {
    const double fold = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(angle(folded(fold)), fold, 1e-14);
    EXPECT_NEAR(angle(folded(-fold)), -fold, 1e-14);
  }
}

TEST(Dihedral, RidgeSeenFromTheNormalsIsPositive) { EXPECT_GT(angle(folded(0.5)), 0); }

TEST(Dihedral, DerivativesNearFlatAndFolded) {
  for (double degrees : {0.0, 1e-10, 1e-6, 0.01, 10.0, 90.0, 170.0, 179.0, 179.9}) {
    for (double sign : {-1.0, 1.0}) expect_derivatives(folded(sign * degrees * std::numbers::pi / 180), 2e-3);
  }
}

TEST(Dihedral, DerivativesAtRandomHinges) {
  std::mt19937 random(4);
  int checked = 0;
  while (checked < 200) {
    const Hinge h = random_hinge(random);
    const Vec3 e = h[1] - h[0];
    const double least =
        std::min({e.norm(), e.cross(h[2] - h[0]).norm() / e.norm(), e.cross(h[3] - h[0]).norm() / e.norm()});
    if (least < 0.02) continue;
    expect_derivatives(h, 1e-3 * least);
    ++checked;
  }
}

TEST(Dihedral, DerivativesNearDegenerate) {
  for (double height : {1e-2, 1e-4, 1e-6}) expect_derivatives(folded(1.0, height, 1.0), 1e-3 * height, 1e-5);
}

TEST(Dihedral, InvariantUnderRigidMotionAndScalesWithSize) {
  std::mt19937 random(5);
  const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (int i = 0; i < 50; ++i) {
    const Hinge h = random_hinge(random);
    Hinge turned = h, tiny = h;
    for (int k = 0; k < 4; ++k) {
      turned[k] = rotation * h[k] + Vec3(3, -2, 1);
      tiny[k] = 1e-3 * h[k];
    }
    EXPECT_NEAR(angle(turned), angle(h), 1e-10);
    const Vec12 g = gradient(h), gt = gradient(turned);
    for (int k = 0; k < 4; ++k) {
      EXPECT_LE((gt.segment<3>(3 * k) - rotation * g.segment<3>(3 * k)).norm(), 1e-9 * g.norm());
    }
    EXPECT_LE((1e-3 * gradient(tiny) - g).norm(), 1e-10 * g.norm());
    EXPECT_LE((1e-6 * hessian(tiny) - hessian(h)).norm(), 1e-9 * hessian(h).norm());
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      force += g.segment<3>(3 * k);
      torque += h[k].cross(Vec3(g.segment<3>(3 * k)));
    }
    EXPECT_LE(force.norm(), 1e-12 * g.norm());
    EXPECT_LE(torque.norm(), 1e-12 * g.norm());
  }
}

TEST(Dihedral, CollapsedHingesHaveNoAngleAndNoDerivatives) {
  const Hinge flat_wing{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0), Vec3(0.5, -1, 0)};
  const Hinge no_edge{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, -1, 0)};
  for (const Hinge& h : {flat_wing, no_edge}) {
    EXPECT_EQ(angle(h), 0);
    EXPECT_TRUE(gradient(h).isZero(0));
    EXPECT_TRUE(hessian(h).isZero(0));
  }
}

}  // namespace
}  // namespace toile
