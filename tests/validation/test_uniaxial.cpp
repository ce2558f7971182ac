// Tensile strips between grips. Without lateral contraction the strip is homogeneous and its force is the closed form
// of St. Venant-Kirchhoff cloth; with it, a long strip's force comes near that of free sides, from above; on the bias,
// with yarns that hardly stretch, the middle shears as a net of rigid rods.

#include "engine/experiments/uniaxial.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/silent.h"

#include <cstdio>

using namespace toile;
using namespace toile::test;

namespace {

Fabric fabric(double poisson) {
  Fabric f = isotropic_fabric(0.15, 1, 1, 0, 1e-6);
  f.stretch_stiffness = {2000, 800, 40};
  f.poisson_stiffness = poisson;
  return f;
}

/// P = Y λ (λ² − 1)/2 with free sides.
double closed_form(double modulus, double strain) {
  const double stretch = 1 + strain;
  return modulus * stretch * (stretch * stretch - 1) / 2;
}

}  // namespace

TEST(UniaxialTest, WithoutContractionIsTheClosedForm) {
  Silent monitor;
  for (const auto& [direction, modulus] : {std::pair{Direction::warp, 2000.0}, {Direction::weft, 800.0}}) {
    UniaxialTest test{fabric(0), direction};
    test.edge_length = 0.01;
    const UniaxialResult ours = pull(test, 1, monitor);
    ASSERT_EQ(ours.drape.report.status, "converged");
    for (const UniaxialReport::Reading& reading : ours.report.curve) {
      const double expected = closed_form(modulus, reading.strain);
      std::printf("strain %.2f: %.4f N/m, reference %.4f\n", reading.strain, reading.force, expected);
      EXPECT_NEAR(reading.force, expected, 1e-4 * expected);
    }
    EXPECT_NEAR(ours.report.shear_angle, 0, 1e-6);
  }
}

TEST(UniaxialTest, GripsMatterLessTheLongerTheStrip) {
  Silent monitor;
  const double modulus = 2000 - 500.0 * 500 / 800, expected = closed_form(modulus, 0.02);
  double last = 1;
  for (const double length : {0.05, 0.1, 0.2, 0.4}) {
    UniaxialTest test{fabric(500), Direction::warp};
    test.length = length;
    test.strains = {0.02};
    test.edge_length = 0.01;
    const double error = pull(test, 1, monitor).report.curve[0].force / expected - 1;
    std::printf("length %.2f m, width 0.05 m: %.3f %% over the strip with free sides\n", length, 100 * error);
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.6 * last);
    last = error;
  }
  EXPECT_LT(last, 0.01);
}

TEST(UniaxialTest, BiasOfStiffYarnsShearsAsANetOfRods) {
  Silent monitor;
  const double degrees = 180 / std::numbers::pi;
  Fabric net = fabric(0);
  net.stretch_stiffness = {4000, 4000, 10};
  UniaxialTest test{net, Direction::bias};
  test.strains = {0.05};
  const UniaxialResult ours = pull(test, 1, monitor);
  ASSERT_EQ(ours.drape.report.status, "converged");
  const double middle = test.length - test.width;
  const double rods = std::numbers::pi / 2 - 2 * std::acos((middle + 0.05 * test.length) / (std::sqrt(2.0) * middle));
  std::printf("bias at 5 %%: shear %.2f degrees, net of rods %.2f\n", degrees * ours.report.shear_angle,
              degrees * rods);
  // Yarns that do stretch smear the borders of the rods' three zones, whose shear is none, half and all.
  EXPECT_NEAR(ours.report.shear_angle, rods, 0.1 * rods);
}

TEST(UniaxialTest, LongBiasStripIsTheOffAxisClosedForm) {
  // 1/Y = (S11 + S22 + 2 S12 + 1/G) / 4 at 45 degrees; warp as stiff as weft, so that the strip stays straight.
  Silent monitor;
  Fabric cloth = fabric(0);
  cloth.stretch_stiffness = {1000, 1000, 40};
  cloth.poisson_stiffness = 200;
  const double determinant = 1000.0 * 1000 - 200.0 * 200;
  const double modulus = 4 / (2 * 1000 / determinant - 2 * 200 / determinant + 1 / 40.0);
  double last = 1;
  for (const double length : {0.1, 0.2, 0.4}) {
    UniaxialTest test{cloth, Direction::bias};
    test.length = length;
    test.width = 0.02;
    test.strains = {1e-3};
    test.edge_length = 0.005;
    const double ours = pull(test, 1, monitor).report.curve[0].force / 1e-3;
    std::printf("bias modulus, length %.1f m: %.3f N/m, free sides %.3f, error %.2f %%\n", length, ours, modulus,
                100 * (ours / modulus - 1));
    EXPECT_GT(ours, modulus);
    EXPECT_LT(ours / modulus - 1, 0.6 * last);
    last = ours / modulus - 1;
  }
  EXPECT_LT(last, 0.03);
}
