#include "engine/terms/tape.h"
#include "tests/engine/terms/check_term.h"

using namespace toile;
using namespace toile::test;

namespace {

constexpr TapeStencil kTape{{0, 1, 2}, 0.012, 4e-5, 0.02};

Potential<3> potential() {
  return {[](const auto& x) { return tape_energy(kTape, x); }, [](const auto& x) { return tape_gradient(kTape, x); },
          [](const auto& x) { return tape_hessian(kTape, x); },
          [](const auto& x) { return tape_hessian_psd(kTape, x); }};
}

const StencilPoints<3> kStraight = {Vec3(0, 0, 0), Vec3(0.011, 0, 0), Vec3(0.024, 0, 0)};

}  // namespace

TEST(Tape, DerivativesWhereverItIsBentTo) {
  std::mt19937 random(3);
  for (double spread : {1e-5, 1e-3, 5e-3})
    for (int k = 0; k < 3; ++k) check_term<3>(potential(), perturbed<3>(kStraight, spread, random), 3e-3, "tape");
}

TEST(Tape, IsStraightAtRestWhereItsPositiveHessianIsExact) {
  EXPECT_LT(tape_energy(kTape, kStraight), 1e-30);
  EXPECT_LT(tape_gradient(kTape, kStraight).norm(), 1e-15);
  const StencilMatrix<3> exact = tape_hessian(kTape, kStraight);
  EXPECT_LT((exact - tape_hessian_psd(kTape, kStraight)).norm(), 1e-12 * exact.norm());
}

TEST(Tape, StoresHalfBOverRadiusSquaredALengthOnACircle) {
  double last = 0;
  for (int n : {24, 48, 96}) {
    const double radius = 0.05, angle = 1.0 / n, chord = 2 * radius * std::sin(0.5 * angle);
    const auto at = [&](double k) { return Vec3(radius * std::cos(k * angle), radius * std::sin(k * angle), 0); };
    const TapeStencil s{{0, 1, 2}, chord, 4e-5, 0};
    const double reference = 0.5 * s.bending / (radius * radius) * radius * angle;
    const double error = std::abs(tape_energy(s, {at(-1), at(0), at(1)}) / reference - 1);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 2, 0.05);
    }
    last = error;
  }
  EXPECT_LT(last, 1e-5);
}

TEST(Tape, DissipationDerivatives) {
  std::mt19937 random(4);
  const StencilPoints<3> x = perturbed<3>(kStraight, 2e-3, random);
  const Potential<3> loss = {[&](const auto& v) { return tape_dissipation(kTape, x, v); },
                             [&](const auto& v) { return tape_dissipation_gradient(kTape, x, v); },
                             [&](const auto&) { return tape_dissipation_hessian(kTape, x); },
                             [&](const auto&) { return tape_dissipation_hessian(kTape, x); }};
  check_derivatives<3>(loss, perturbed<3>(x, 0.2, random), 1, "dissipation");
}
