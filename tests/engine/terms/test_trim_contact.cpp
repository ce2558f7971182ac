#include "engine/terms/trim_contact.h"
#include "tests/engine/terms/check_term.h"
#include "tests/engine/terms/rotation_chart.h"

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kTrimGyration = 4e-3, kTrimStiffness = 100;

/// A point of the cloth against a trim (side −1), or a point of a trim against the body (side 1).
TrimContact contact(double side, double friction) {
  TrimContact c;
  c.side = side;
  c.point = {3e-3, -2e-3, 1e-3};
  if (side < 0) {
    c.contact.count = 3;
    c.contact.weights = {0.2, 0.5, 0.3, 0};
  }
  c.contact.normal = Vec3(0.2, 0.9, -0.3).normalized();
  c.contact.distance = 2e-3;
  c.contact.friction = friction;
  return c;
}

TrimContactState state(const TrimContact& c, const StencilPoints<5>& x, const Mat3& start) {
  const Mat3 now = rotation_by(x[4] / kTrimGyration).toRotationMatrix() * start;
  return trim_contact_state(c, {x[0], x[1], x[2]}, x[3], now, kTrimGyration);
}

/// In the chart of rotation vectors about `start`.
Potential<5> potential(const TrimContact& c, const Mat3& start) {
  return {[=](const auto& x) { return trim_contact_energy(c, kTrimStiffness, state(c, x, start)); },
          [=](const auto& x) {
            StencilVector<5> g = trim_contact_gradient(c, kTrimStiffness, state(c, x, start));
            g.segment<3>(12) = left_jacobian(x[4] / kTrimGyration).transpose() * g.segment<3>(12);
            return g;
          },
          [=](const auto& x) { return trim_contact_hessian(c, kTrimStiffness, state(c, x, start)); },
          [=](const auto& x) { return trim_contact_hessian_psd(c, kTrimStiffness, state(c, x, start)); }};
}

StencilPoints<5> nodes(std::mt19937& random) {
  const StencilPoints<5> x = {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0), Vec3(3e-3, 3e-3, 2e-3), Vec3::Zero()};
  StencilPoints<5> moved = perturbed<5>(x, 1e-3, random);
  moved[4].setZero();
  return moved;
}

/// Puts the contact where it is pressed by `depth` and has been dragged by `along`.
void press(TrimContact& c, const StencilPoints<5>& x, const Mat3& start, double depth, const Vec3& along) {
  const Vec3 p = state(c, x, start).point;
  c.contact.offset = c.contact.normal.dot(p) - c.contact.distance + depth;
  c.contact.anchor = p - along;
}

}  // namespace

TEST(TrimContact, DerivativesWithRespectToClothCentreAndRotation) {
  std::mt19937 random(3);
  for (double side : {-1.0, 1.0})
    for (double depth : {1e-4, 1e-3, 4e-3}) {
      const Mat3 start = random_rotation(random);
      const StencilPoints<5> x = nodes(random);
      TrimContact smooth = contact(side, 0), sticking = contact(side, 0.5);
      press(smooth, x, start, depth, Vec3::Zero());
      check_derivatives<5>(potential(smooth, start), x, depth, "pressed");
      press(sticking, x, start, depth, 0.1 * depth * Vec3(1, 0, 1));
      ASSERT_FALSE(contact_response(sticking.contact, kTrimStiffness, state(sticking, x, start).point).sliding);
      check_derivatives<5>(potential(sticking, start), x, 0.3 * depth, "sticking");
    }
}

TEST(TrimContact, PartsOfTheSystemAreItsPositiveHessianAndForce) {
  std::mt19937 random(4);
  const Mat3 start = random_rotation(random);
  const StencilPoints<5> x = nodes(random);
  TrimContact c = contact(-1, 0.3);
  press(c, x, start, 1e-3, Vec3(2e-3, 0, 1e-3));
  const TrimContactState at = state(c, x, start);
  ASSERT_TRUE(contact_response(c.contact, kTrimStiffness, at.point).sliding);
  const TrimContactResponse r = trim_contact_response(c, kTrimStiffness, at);
  EXPECT_LT((r.force + trim_contact_gradient(c, kTrimStiffness, at)).norm(), 1e-15);
  const StencilMatrix<5> psd = trim_contact_hessian_psd(c, kTrimStiffness, at);
  StencilMatrix<5> exact = trim_contact_hessian(c, kTrimStiffness, at);
  // Both have the same blocks but for the load on the lever, of which the one keeps what is positive.
  const Mat3 dropped = (psd - exact).block<3, 3>(12, 12);
  exact.block<3, 3>(12, 12) += dropped;
  EXPECT_LT((psd - exact).norm(), 1e-12 * psd.norm());
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(dropped);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * psd.norm());
}

TEST(TrimContact, ForcesAndTorquesBalanceWhereItWasDetectedFrictionIncluded) {
  std::mt19937 random(5);
  const Mat3 start = random_rotation(random);
  const StencilPoints<5> x = nodes(random);
  TrimContact c = contact(-1, 0.4);
  const Vec3 on_cloth = 0.2 * x[0] + 0.5 * x[1] + 0.3 * x[2];
  c.point = start.transpose() * (on_cloth - x[3]);
  press(c, x, start, 1e-3, Vec3(2e-3, 0, 1e-3));
  const StencilVector<5> g = trim_contact_gradient(c, kTrimStiffness, state(c, x, start));
  Vec3 force = Vec3::Zero(), torque = kTrimGyration * g.segment<3>(12);
  for (int i = 0; i < 4; ++i) {
    force += g.segment<3>(3 * i);
    torque += (x[i] - x[3]).cross(g.segment<3>(3 * i));
  }
  EXPECT_GT(g.norm(), 1e-3);
  EXPECT_LT(force.norm(), 1e-14 * g.norm());
  EXPECT_LT(torque.norm(), 1e-15 * g.norm());
}

TEST(TrimContact, AnOpenOneDoesNothing) {
  std::mt19937 random(6);
  const Mat3 start = random_rotation(random);
  const StencilPoints<5> x = nodes(random);
  TrimContact c = contact(1, 0.4);
  press(c, x, start, -1e-5, Vec3(1e-3, 0, 0));
  const TrimContactState at = state(c, x, start);
  EXPECT_EQ(trim_contact_energy(c, kTrimStiffness, at), 0);
  EXPECT_EQ(trim_contact_gradient(c, kTrimStiffness, at).norm(), 0);
  EXPECT_EQ(trim_contact_hessian_psd(c, kTrimStiffness, at).norm(), 0);
}
