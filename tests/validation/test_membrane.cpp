// Stretch and shear of one element against the closed forms of St. Venant–Kirchhoff cloth, and a strip under its own
// weight.

#include "engine/solve/backward_euler.h"
#include "engine/terms/membrane.h"
#include "tests/engine/solve/sheets.h"
#include "tests/validation/references.h"

#include <Eigen/LU>

#include <numbers>

using namespace toile;
using namespace toile::test;

namespace {

/// A triangle of the references' fabric (index 1 is warp there), drawn turned by `angle` in the flat pattern.
MembraneStencil element(std::array<Vec2, 3>& flat) {
  Cloth cloth;
  flat = {Vec2(0.01, 0.02), Vec2(0.025, 0.024), Vec2(0.013, 0.036)};
  cloth.triangles = {{0, 1, 2}};
  cloth.flat = {flat};
  cloth.triangle_panel = {0};
  cloth.panels.resize(1);
  Fabric f;
  f.stretch_stiffness = {reference("/membrane_stvk/C11_C12_C22_G/0"), reference("/membrane_stvk/C11_C12_C22_G/2"),
                         reference("/membrane_stvk/C11_C12_C22_G/3")};
  f.poisson_stiffness = reference("/membrane_stvk/C11_C12_C22_G/1");
  cloth.fabrics = {f};
  return membrane_stencils(cloth).front();
}

/// First Piola–Kirchhoff stress [N/m] under a homogeneous in-plane deformation, from nodal forces: A P = Σ gᵢ Xᵢᵀ. Both
/// tensors in (weft, warp).
Mat2 stress(const Mat2& deformation) {
  std::array<Vec2, 3> flat;
  const MembraneStencil s = element(flat);
  StencilPoints<3> x;
  for (int i = 0; i < 3; ++i) x[i] << deformation * flat[i], 0;
  const StencilVector<3> g = membrane_gradient(s, x);
  Mat2 p = Mat2::Zero();
  for (int i = 0; i < 3; ++i) p += g.segment<2>(3 * i) * flat[i].transpose() / s.rest_area;
  return p;
}

}  // namespace

TEST(MembraneReference, UniaxialAlongWarp) {
  SKIP_WITHOUT_REFERENCES();
  for (int row = 0; row < 4; ++row) {
    const std::string at = "/membrane_stvk/uniaxial_warp/" + std::to_string(row);
    const double stretch = reference(at + "/stretch");
    const Mat2 free = stress(Eigen::DiagonalMatrix<double, 2>(reference(at + "/lateral_stretch"), stretch));
    EXPECT_NEAR(free(1, 1), reference(at + "/force_per_width"), 1e-6 * free(1, 1)) << stretch;
    EXPECT_LT(std::abs(free(0, 0)), 1e-5 * free(1, 1)) << stretch;
    const Mat2 confined = stress(Eigen::DiagonalMatrix<double, 2>(1, stretch));
    EXPECT_NEAR(confined(1, 1), reference(at + "/confined_force"), 1e-9 * confined(1, 1)) << stretch;
    EXPECT_NEAR(confined(0, 0), reference(at + "/confined_transverse_S22"), 1e-9 * confined(1, 1)) << stretch;
  }
}

TEST(MembraneReference, SimpleShear) {
  SKIP_WITHOUT_REFERENCES();
  for (int row = 0; row < 3; ++row) {
    const std::string at = "/membrane_stvk/simple_shear/" + std::to_string(row);
    Mat2 shear = Mat2::Identity();
    shear(1, 0) = reference(at + "/gamma");  // weft fibres lean towards warp (1 = warp, 2 = weft in the references)
    const Mat2 p = stress(shear);
    const double scale = reference(at + "/P12");
    EXPECT_NEAR(p(1, 0), reference(at + "/P12"), 1e-9 * scale);
    EXPECT_NEAR(p(0, 1), reference(at + "/P21"), 1e-9 * scale);
    EXPECT_NEAR(p(1, 1), reference(at + "/P11"), 1e-9 * scale);
    EXPECT_NEAR(p(0, 0), reference(at + "/P22"), 1e-9 * scale);
  }
}

TEST(MembraneReference, OffAxisModulus) {
  SKIP_WITHOUT_REFERENCES();
  for (int row = 0; row < 7; ++row) {
    const std::string at = "/membrane_stvk/small_strain_modulus_vs_angle/" + std::to_string(row);
    // Pull along a direction `deg` from warp; the other two strains follow from no stress across.
    const double angle = reference(at + "/deg") * std::numbers::pi / 180;
    Mat2 axes;  // columns: along, across, in (weft, warp)
    axes << std::sin(angle), std::cos(angle), std::cos(angle), -std::sin(angle);
    const auto response = [&](double along, double across, double shear) {
      const double small = 1e-6;
      Mat2 strain;
      strain << along, shear, shear, across;
      const Mat2 p = stress(Mat2::Identity() + small * axes * strain * axes.transpose());
      const Mat2 local = axes.transpose() * p * axes / small;
      return Vec3(local(0, 0), local(1, 1), local(0, 1));
    };
    const Vec3 pull = response(1, 0, 0), lateral = response(0, 1, 0), shear = response(0, 0, 1);
    Mat2 across;
    across << lateral[1], shear[1], lateral[2], shear[2];
    const Vec2 follow = across.inverse() * -Vec2(pull[1], pull[2]);
    EXPECT_NEAR(pull[0] + lateral[0] * follow[0] + shear[0] * follow[1], reference(at + "/Y"),
                1e-4 * reference(at + "/Y"))
        << "at " << angle;
  }
}

TEST(MembraneReference, HangingStrip) {
  SKIP_WITHOUT_REFERENCES();
  // ρ g L / Y = 0.05 and 0.2 with no lateral coupling, so that the held edge disturbs nothing.
  for (double ratio : {0.05, 0.2}) {
    const int rows = 40;
    const double height = 5e-3, length = rows * height, edge = height * 2 / std::sqrt(3.0);
    Fabric fabric = isotropic_fabric(0.2, 0.2 * kGravity * length / ratio, 5, 0, 1e-7);
    fabric.membrane_damping = 5e-2;
    const Cloth strip =
        equilateral_sheet(3, rows, edge, fabric, [](const Vec2& uv) { return Vec3(uv.x(), uv.y(), 0); });
    BackwardEuler solver(strip, SolverOptions{});
    State state{strip.x, Positions(strip.x.size(), Vec3::Zero())};
    Kinematic kinematic{std::vector<char>(strip.x.size(), 0), strip.x};
    for (std::size_t i = 0; i < strip.x.size(); ++i) kinematic.held[i] = strip.x[i].y() > length - 1e-9;
    std::vector<Contact> none;
    StepTimes times;
    for (int k = 0; k < 600; ++k) ASSERT_TRUE(solver.step(state, 5e-3, 1, none, kinematic, times).accepted) << k;
    const double elongation = -state.x[0].y() / length;
    const int row = reference_row("/membrane_stvk/hanging", "rhogL_over_Y", ratio);
    const double expected = reference("/membrane_stvk/hanging/" + std::to_string(row) + "/stvk");
    EXPECT_NEAR(elongation, expected, 0.002 * expected) << ratio;
  }
}
