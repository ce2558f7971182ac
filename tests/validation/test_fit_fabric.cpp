// The fabric from its measurements: readings by closed forms, the elastica and finer meshes than the fit's own, back to
// the stiffness behind them.

#include "engine/experiments/fit_fabric.h"
#include "engine/experiments/measured_specimen.h"
#include "engine/experiments/uniaxial.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/pear_elastica.h"
#include "tests/validation/silent.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace toile;
using namespace toile::test;
using testing::Contains;
using testing::IsEmpty;
using testing::StartsWith;

namespace {

constexpr double kPeirceAngle = 41.5 * std::numbers::pi / 180;

std::size_t at(Direction direction) { return static_cast<std::size_t>(direction); }

/// Of 0.2 kg/m², and nothing like what is measured.
FabricMeasurements with_base(double poisson_ratio = 0.2) {
  FabricMeasurements m;
  m.base = isotropic_fabric(0.1, 9000, 300, poisson_ratio * 9000, 3e-5);
  m.base.name = "base";
  m.base.thickness = 2e-4;
  m.area_density = 0.2;
  return m;
}

/// P = Y λ (λ² − 1)/2 with free sides.
double free_force(double modulus, double strain) {
  const double stretch = 1 + strain;
  return modulus * stretch * (stretch * stretch - 1) / 2;
}

MeasuredPull small_pull(bool as_curve) {
  MeasuredPull test;
  test.length = 0.1;
  test.width = 0.025;
  test.as_curve = as_curve;
  return test;
}

/// A strip whose overhang hangs at 41.5°: D = ρ g (overhang/2)³.
MeasuredCantilever at_peirces_angle(double overhang, double width) {
  MeasuredCantilever test;
  test.overhang = overhang;
  test.width = width;
  test.value = kPeirceAngle;
  return test;
}

void print(const char* name, double reference, double ours) {
  std::printf("%s: reference %.5g, ours %.5g, error %.2f %%\n", name, reference, ours, 100 * (ours / reference - 1));
}

}  // namespace

TEST(FitFabric, StripsWithoutContractionGiveTheClosedFormsModuli) {
  Silent monitor;
  FabricMeasurements m = with_base(0);
  for (const auto& [direction, modulus] : {std::pair{Direction::warp, 2000.0}, {Direction::weft, 800.0}}) {
    MeasuredPull test = small_pull(false);
    for (const double strain : {0.005, 0.02}) test.readings.push_back({strain, free_force(modulus, strain)});
    m.pulls[at(direction)] = test;
  }
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "fitted");
  print("C warp [N/m]", 2000, fit.fabric.stretch_stiffness.warp);
  print("C weft [N/m]", 800, fit.fabric.stretch_stiffness.weft);
  EXPECT_NEAR(fit.fabric.stretch_stiffness.warp, 2000, 1e-3 * 2000);
  EXPECT_NEAR(fit.fabric.stretch_stiffness.weft, 800, 1e-3 * 800);
  EXPECT_LT(fit.rms, 1e-3);
}

TEST(FitFabric, NoiseOfTwoPerCentIsAMisfitOfTwoPerCentAndDoesNotDerail) {
  Silent monitor;
  FabricMeasurements m = with_base(0);
  MeasuredPull test = small_pull(false);
  int k = 0;
  for (const double strain : {0.004, 0.008, 0.012, 0.016, 0.02, 0.024, 0.028, 0.032})
    test.readings.push_back({strain, free_force(2000, strain) * (k++ % 3 == 0 ? 1.03 : 0.985)});
  m.pulls[at(Direction::warp)] = test;
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "fitted");
  const ParameterEstimate& warp = fit.parts.at(0).parameters.at(0);
  print("C warp of noisy readings [N/m]", 2000, fit.fabric.stretch_stiffness.warp);
  std::printf("misfit rms %.2f %%, standard error %.2f %%\n", 100 * fit.rms, 100 * warp.standard_error);
  EXPECT_NEAR(fit.rms, 0.0217, 0.003);
  EXPECT_NEAR(fit.fabric.stretch_stiffness.warp, 2000, 3 * warp.standard_error * 2000);
  EXPECT_NEAR(warp.standard_error, 0.022 / std::sqrt(8.0), 0.003);
}

TEST(FitFabric, OverhangAt41Point5DegreesIsPeircesStiffness) {
  Silent monitor;
  FabricMeasurements m = with_base();
  m.cantilevers[at(Direction::warp)] = at_peirces_angle(0.05, 0.025);
  const double expected = 0.2 * kGravity * std::pow(0.025, 3);
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "fitted");
  print("D warp = rho g (l/2)^3 [N m]", expected, fit.fabric.bending_stiffness.warp);
  EXPECT_NEAR(fit.fabric.bending_stiffness.warp, expected, 0.02 * expected);
  EXPECT_TRUE(fit.parts.at(0).parameters.at(0).determined);
  EXPECT_THAT(fit.kept, Contains("/bending_uN_m/weft"));
}

TEST(FitFabric, LoopOfTheElasticaGivesItsStiffness) {
  Silent monitor;
  for (const double weight : {300.0, 1000.0}) {
    FabricMeasurements m = with_base();
    m.thickness = 2e-5;
    const double length = 0.15, expected = 0.2 * kGravity * std::pow(length, 3) / weight;
    MeasuredLoop test;
    test.length = length;
    test.width = 0.015;
    test.height = length * PearElastica(weight).height();
    m.loops[at(Direction::weft)] = test;
    const FabricFit fit = fit_fabric(m, 0, monitor);
    EXPECT_EQ(fit.status, "fitted");
    const ParameterEstimate& weft = fit.parts.at(0).parameters.at(0);
    std::printf("loop of weight %.0f D/L2: ", weight);
    print("D weft [N m]", expected, fit.fabric.bending_stiffness.weft);
    std::printf("standard error by half a per cent of the height: %.0f %%\n", 100 * weft.standard_error);
    EXPECT_NEAR(fit.fabric.bending_stiffness.weft, expected, 0.03 * expected);
    EXPECT_GT(weft.standard_error, 0.1);
  }
}

TEST(FitFabric, AlmostWeightlessLoopDoesNotTellTheStiffnessAndThisIsSaid) {
  Silent monitor;
  FabricMeasurements m = with_base();
  m.thickness = 2e-5;
  MeasuredLoop test;
  test.length = 0.1;
  test.width = 0.01;
  test.height = 0.1 * PearElastica(30).height();
  test.uncertainty = 0.02;
  m.loops[at(Direction::warp)] = test;
  const FabricFit fit = fit_fabric(m, 0, monitor);
  std::printf("weight 30 D/L2: standard error %.0f %%, singular value %.2g, %ld simulations\n",
              100 * fit.parts.at(0).parameters.at(0).standard_error, fit.parts.at(0).singular_values.at(0),
              fit.simulations);
  EXPECT_FALSE(fit.parts.at(0).parameters.at(0).determined);
  EXPECT_THAT(fit.warnings, Contains(StartsWith("not_determined")));
}

TEST(FitFabric, RoundTripThroughStripsWithGripsOnFinerMeshes) {
  Silent monitor;
  Fabric cloth = isotropic_fabric(0.2, 0, 0, 0, 1e-5);
  cloth.stretch_stiffness = {2000, 1200, 40};
  cloth.poisson_stiffness = 0.2 * std::sqrt(2000.0 * 1200.0);
  FabricMeasurements m = with_base();
  for (const Direction direction : {Direction::warp, Direction::weft, Direction::bias}) {
    MeasuredPull test = small_pull(direction != Direction::weft);
    UniaxialTest lab{cloth, direction, test.length, test.width, {0.01, 0.02, 0.04}, test.width / 8};
    const std::vector<UniaxialReport::Reading> coarse = pull(lab, 0, monitor).report.curve;
    std::vector<UniaxialReport::Reading> fine = coarse;
    if (direction == Direction::bias) {
      lab.edge_length /= 2;
      fine = pull(lab, 0, monitor).report.curve;
    }
    for (std::size_t i = 0; i < fine.size(); ++i)
      test.readings.push_back({fine[i].strain, 2 * fine[i].force - coarse[i].force});
    m.pulls[at(direction)] = test;
  }
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "fitted");
  const Fabric& ours = fit.fabric;
  print("C weft [N/m]", 1200, ours.stretch_stiffness.weft);
  EXPECT_NEAR(ours.stretch_stiffness.weft, 1200, 0.01 * 1200);
  for (const double strain : {0.01, 0.03}) {
    print("warp's tangent [N/m]", 2000, ours.warp_stress.at(strain).tangent);
    print("shear modulus [N/m]", 40, 0.5 * ours.shear_stress.at(strain).tangent);
    EXPECT_NEAR(ours.warp_stress.at(strain).tangent, 2000, 0.02 * 2000);
    // On the bias, the fit's meshes and those of this test are right to 2 % each.
    EXPECT_NEAR(0.5 * ours.shear_stress.at(strain).tangent, 40, 0.04 * 40);
  }
  std::printf(
      "grips on the bias: free strip's force over the clamped one's %.3f; misfit rms %.2f %%, %ld simulations\n",
      fit.parts.at(0).parameters.back().value, 100 * fit.rms, fit.simulations);
  EXPECT_LT(fit.parts.at(0).parameters.back().value, 0.95);
  EXPECT_LT(fit.rms, 5e-3);
  EXPECT_THAT(fit.parts.at(0).singular_values, testing::SizeIs(7));
}

TEST(FitFabric, WhatIsNotMeasuredIsTheBasesAndSaidSo) {
  Silent monitor;
  FabricMeasurements m = with_base();
  m.bending[at(Direction::warp)] = MeasuredStiffness{4e-6};
  m.bending[at(Direction::weft)] = MeasuredStiffness{2e-6};
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "fitted");
  EXPECT_EQ(fit.simulations, 0);
  EXPECT_NEAR(fit.fabric.bending_stiffness.warp, 4e-6, 1e-9);
  EXPECT_NEAR(fit.fabric.bending_stiffness.bias, 3e-6, 1e-9);
  EXPECT_EQ(fit.fabric.stretch_stiffness, m.base.stretch_stiffness);
  EXPECT_EQ(fit.fabric.area_density, 0.2);
  EXPECT_THAT(fit.warnings, Contains(StartsWith("shear_not_measured")));
  EXPECT_THAT(fit.warnings, Contains(StartsWith("stretch_not_measured")));
  EXPECT_THAT(fit.warnings, Contains(StartsWith("bias_bending_not_measured")));
  EXPECT_THAT(fit.kept, Contains("/stretch_N_m/bias"));
  EXPECT_THAT(fit.kept, testing::Not(Contains("/bending_uN_m/bias")));
}

TEST(FitFabric, TwoTestsThatContradictEachOtherAreNotFitted) {
  Silent monitor;
  FabricMeasurements m = with_base();
  m.cantilevers[at(Direction::warp)] = at_peirces_angle(0.06, 0.02);
  m.bending[at(Direction::warp)] = MeasuredStiffness{10 * 0.2 * kGravity * std::pow(0.03, 3)};
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "not_fitted");
  EXPECT_EQ(fit.stop_reason, "misfit_too_large");
}

TEST(FitFabric, BendingThatNoSheetCanHaveIsNotFitted) {
  Silent monitor;
  FabricMeasurements m = with_base();
  m.bending[at(Direction::warp)] = MeasuredStiffness{1e-4};
  m.bending[at(Direction::weft)] = MeasuredStiffness{4e-6};
  m.bending[at(Direction::bias)] = MeasuredStiffness{5e-6};
  const FabricFit fit = fit_fabric(m, 0, monitor);
  EXPECT_EQ(fit.status, "not_fitted");
  EXPECT_EQ(fit.stop_reason, "no_such_fabric");
}

TEST(FitFabric, DoesNotDependOnTheNumberOfThreads) {
  Silent monitor;
  FabricMeasurements m = with_base();
  MeasuredPull test = small_pull(false);
  test.readings = {{0.01, 20}};
  m.pulls[at(Direction::warp)] = m.pulls[at(Direction::weft)] = test;
  test.readings = {{0.02, 3}};
  m.pulls[at(Direction::bias)] = test;
  const FabricFit one = fit_fabric(m, 1, monitor), two = fit_fabric(m, 2, monitor);
  EXPECT_EQ(one.fabric, two.fabric);
  EXPECT_EQ(one.rms, two.rms);
  EXPECT_EQ(one.simulations, two.simulations);
}

TEST(FitFabric, CanBeCancelled) {
  struct Stop final : Monitor {
    bool report(const Progress&) override { return false; }
  } stop;
  FabricMeasurements m = with_base();
  m.pulls[at(Direction::warp)] = small_pull(false);
  m.pulls[at(Direction::warp)]->readings = {{0.01, 20}};
  EXPECT_THROW(fit_fabric(m, 0, stop), Cancelled);
}
