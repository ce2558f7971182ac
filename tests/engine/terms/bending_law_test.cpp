#include "engine/terms/bending_law.h"

#include "engine/terms/curvature_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>

using namespace toile;

namespace {

const Directional kD = {8e-6, 3e-6, 5e-6}, kSoftening = {4e-3, 2e-3, 3e-3}, kMoment = {3e-4, 1e-4, 2e-4};

Directional squares(const Directional& d) { return {d.warp * d.warp, d.weft * d.weft, d.bias * d.bias}; }

BendingLaw softening_law() {
  BendingLaw law;
  law.area = 1e-4;
  law.stiffness = directional_tensor(kD);
  law.softening = directional_tensor(squares(kSoftening));
  return law;
}

BendingLaw friction_law(double onset_curvature) {
  BendingLaw law;
  law.area = 1e-4;
  law.stiffness = directional_tensor(kD);
  law.friction = directional_tensor(squares(kMoment));
  law.onset = onset_curvature * (kMoment.warp + kMoment.weft + kMoment.bias) / 3;
  return law;
}

const Vec3 kWarp(0, 1, 0), kWeft(1, 0, 0), kBias(0.5, 0.5, 1);  ///< cylinders of curvature 1/m

}  // namespace

TEST(BendingLaw, MomentIsTheMeasuredQuadraticAndNeverFalls) {
  const BendingLaw law = softening_law();
  struct Case {
    Vec3 cylinder;
    double d, r;
  };
  for (const Case& c : {Case{kWarp, kD.warp, kSoftening.warp}, Case{kWeft, kD.weft, kSoftening.weft},
                        Case{kBias, kD.bias, kSoftening.bias}}) {
    double last = 0;
    for (double curvature = 1; curvature < 2000; curvature *= 1.05) {
      const double moment = c.cylinder.dot(law_moment(law, curvature * c.cylinder));
      if (c.r * curvature < 0.45) {
        EXPECT_NEAR(moment, c.d * curvature - c.d * c.r * curvature * curvature, 1e-9 * moment);
      }
      EXPECT_GT(moment, last) << curvature;
      last = moment;
    }
  }
}

TEST(BendingLaw, LoopIsAsWideAsMeasured) {
  // KES: bend to 250/m, back to −250/m, and bend again; the loop's width at any curvature past the onset is 2HB.
  for (const auto& [cylinder, width] :
       {std::pair{kWarp, 2 * kMoment.warp}, {kWeft, 2 * kMoment.weft}, {kBias, 2 * kMoment.bias}}) {
    BendingLaw law = friction_law(20);
    double bending = 0, unbending = 0, dissipated = 0, last = 0;
    double curvature = 0;
    const auto run = [&](double to) {
      const double step = to > curvature ? 1 : -1;
      while (std::abs(curvature - to) > 0.5) {
        curvature += step;
        const double moment = cylinder.dot(law_moment(law, curvature * cylinder));
        law.slip = advanced_slip(law, curvature * cylinder);
        dissipated += 0.5 * (moment + last) * step;
        last = moment;
        if (std::abs(curvature - 100) < 0.5) (step > 0 ? bending : unbending) = moment;
      }
    };
    run(250);
    run(-250);
    dissipated = 0;
    run(250);
    run(-250);
    EXPECT_NEAR(bending - unbending, width, 1e-9 * width);
    EXPECT_GT(dissipated, 0.8 * width * 500);  // the sticking parts give back what they took
    EXPECT_LT(dissipated, width * 500);
  }
}

TEST(BendingLaw, ResidualCurvatureAfterUnloading) {
  // Without load D κ + HB-sized friction balance: κ = HB/(D + HB/onset) after bending far.
  BendingLaw law = friction_law(20);
  law.slip = advanced_slip(law, 200 * kWeft);
  double low = -100, high = 200;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (kWeft.dot(law_moment(law, middle * kWeft)) > 0 ? high : low) = middle;
  }
  // The weft slides at y = y₀, that is at the change y₀/HB of curvature, and sticks with the slope HB²/y₀.
  const double slope = kMoment.weft * kMoment.weft / law.onset, slid = 200 - law.onset / kMoment.weft;
  const double sticking = slope * slid / (kD.weft + slope);
  const double sliding = kMoment.weft / kD.weft;  // where it slid back already
  EXPECT_NEAR(low, std::min(sticking, sliding), 1e-6);
  EXPECT_GT(low, 1);
}

TEST(BendingLaw, SecantIsNoSofterThanTheTangentOnCylinders) {
  for (BendingLaw law : {softening_law(), friction_law(15)})
    for (double curvature : {0.0, 1.0, 20.0, 80.0, 150.0, 400.0}) {
      const Vec3 at = curvature * kBias;
      const Mat3 secant = law_secant(law, at), tangent = law_tangent(law, at);
      EXPECT_GT(secant.selfadjointView<Eigen::Upper>().eigenvalues().minCoeff(), 0);
      EXPECT_GE(kBias.dot(secant * kBias), (1 - 1e-12) * kBias.dot(tangent * kBias));
      if (curvature == 0) {
        EXPECT_LT((secant - tangent).norm(), 1e-12 * tangent.norm());
      }
    }
}
