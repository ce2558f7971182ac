#include "engine/terms/attachment.h"
#include "tests/engine/terms/check_term.h"
#include "tests/engine/terms/rotation_chart.h"

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kGyration = 4e-3;
const AttachmentStencil kSpring{{0, 1, 2}, {0.2, 0.5, 0.3}, 0, Vec3(3e-3, -2e-3, 1e-3), 800, 0.01};

AttachmentState state(const StencilPoints<5>& x, const Mat3& start) {
  const Mat3 now = rotation_by(x[4] / kGyration).toRotationMatrix() * start;
  return attachment_state(kSpring, {x[0], x[1], x[2], x[3]}, now, kGyration);
}

/// In the chart of rotation vectors about `start`; the term itself speaks of increments about where it is, which is the
/// same at the chart's origin.
Potential<5> potential(const Mat3& start) {
  return {[=](const auto& x) { return attachment_energy(kSpring, state(x, start)); },
          [=](const auto& x) {
            StencilVector<5> g = attachment_gradient(kSpring, state(x, start));
            g.segment<3>(12) = left_jacobian(x[4] / kGyration).transpose() * g.segment<3>(12);
            return g;
          },
          [=](const auto& x) { return attachment_hessian(kSpring, state(x, start)); },
          [=](const auto& x) { return attachment_hessian_psd(kSpring, state(x, start)); }};
}

StencilPoints<5> nodes(double stretch, std::mt19937& random) {
  StencilPoints<5> x = {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0), Vec3(0.003, 0.003, 0.002), Vec3::Zero()};
  x = perturbed<5>(x, stretch, random);
  x[4].setZero();
  return x;
}

}  // namespace

TEST(Attachment, DerivativesWithRespectToClothCentreAndRotation) {
  std::mt19937 random(3);
  for (double stretch : {1e-4, 2e-3, 2e-2})
    for (int k = 0; k < 3; ++k)
      check_derivatives<5>(potential(random_rotation(random)), nodes(stretch, random), 2e-3, "attachment");
}

TEST(Attachment, DissipationDerivatives) {
  std::mt19937 random(4);
  const StencilPoints<5> x = nodes(2e-3, random);
  const AttachmentState at = state(x, random_rotation(random));
  const Potential<5> loss = {[&](const auto& v) { return attachment_dissipation(kSpring, at, v); },
                             [&](const auto& v) { return attachment_dissipation_gradient(kSpring, at, v); },
                             [&](const auto&) { return attachment_dissipation_hessian(kSpring, at); },
                             [&](const auto&) { return attachment_dissipation_hessian(kSpring, at); }};
  check_derivatives<5>(loss, perturbed<5>(x, 0.2, random), 1, "dissipation");
}

TEST(Attachment, ForcesAndTorquesBalance) {
  std::mt19937 random(5);
  const StencilPoints<5> x = nodes(2e-3, random);
  const StencilVector<5> g = attachment_gradient(kSpring, state(x, random_rotation(random)));
  Vec3 force = Vec3::Zero(), torque = kGyration * g.segment<3>(12);
  for (int i = 0; i < 4; ++i) {
    force += g.segment<3>(3 * i);
    torque += (x[i] - x[3]).cross(g.segment<3>(3 * i));
  }
  EXPECT_LT(force.norm(), 1e-12 * g.norm());
  EXPECT_LT(torque.norm(), 1e-12 * g.norm());
}
