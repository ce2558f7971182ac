#include "engine/terms/membrane.h"

#include "engine/scene/stretch_test.h"
#include "tests/engine/terms/check_term.h"

using namespace toile;
using namespace toile::test;

namespace {

/// One triangle of anisotropic cloth. Mirrored: drawn clockwise in the flat pattern, so its signed flat area is
/// negative.
Cloth one_triangle(bool mirrored = false) {
  Cloth cloth;
  cloth.triangles = {{0, 1, 2}};
  std::array<Vec2, 3> flat = {Vec2(0.01, 0.02), Vec2(0.022, 0.024), Vec2(0.014, 0.033)};
  if (mirrored)
    for (Vec2& p : flat) p.x() = -p.x();
  cloth.flat = {flat};
  cloth.triangle_panel = {0};
  cloth.panels.resize(1);
  Fabric f;
  f.area_density = 0.2;
  f.stretch_stiffness = {1000, 600, 50};
  f.poisson_stiffness = 200;
  cloth.fabrics = {f};
  for (const Vec2& p : flat) cloth.x.emplace_back(p.x(), p.y(), 0);
  return cloth;
}

MembraneStencil stencil(bool mirrored = false) { return membrane_stencils(one_triangle(mirrored)).front(); }

StencilPoints<3> rest(bool mirrored = false) {
  const Cloth cloth = one_triangle(mirrored);
  return {cloth.x[0], cloth.x[1], cloth.x[2]};
}

/// A stencil of cloth measured in all three directions: a soft toe, then stiffening.
MembraneStencil measured_stencil() {
  Cloth cloth = one_triangle();
  const StretchTest readings{{{0.01, 4}, {0.03, 20}, {0.06, 80}, {0.1, 220}},
                             {{0.02, 4}, {0.06, 20}, {0.12, 90}},
                             {{0.03, 3}, {0.08, 12}, {0.15, 40}}};
  apply_stretch_test(readings, 0.25, "", cloth.fabrics[0]);
  return membrane_stencils(cloth).front();
}

Potential<3> elastic(const MembraneStencil& s) {
  return {[=](const auto& x) { return membrane_energy(s, x); }, [=](const auto& x) { return membrane_gradient(s, x); },
          [=](const auto& x) { return membrane_hessian(s, x); },
          [=](const auto& x) { return membrane_hessian_psd(s, x); }};
}

Potential<3> dissipation(const MembraneStencil& s, const StencilPoints<3>& x) {
  return {[=](const auto& v) { return membrane_dissipation(s, x, v); },
          [=](const auto& v) { return membrane_dissipation_gradient(s, x, v); },
          [=](const auto&) { return membrane_dissipation_hessian(s, x); },
          [=](const auto&) { return membrane_dissipation_hessian(s, x); }};
}

StencilPoints<3> scaled_in_plane(double u, double v) {
  StencilPoints<3> x = rest();
  for (Vec3& p : x) p = Vec3(u * p.x(), v * p.y(), 0);
  return x;
}

constexpr double kSize = 0.012;  ///< of the triangle [m]

}  // namespace

TEST(Membrane, DerivativesAtRest) {
  for (bool mirrored : {false, true}) {
    check_term<3>(elastic(stencil(mirrored)), rest(mirrored), kSize, "rest");
    EXPECT_EQ(membrane_gradient(stencil(mirrored), rest(mirrored)).norm() < 1e-12, true);
  }
}

TEST(Membrane, DerivativesAtRandomStates) {
  std::mt19937 random(1);
  for (double spread : {1e-4, 1e-3, 5e-3})
    for (int k = 0; k < 20; ++k)
      check_term<3>(elastic(stencil()), perturbed<3>(rest(), spread, random), 0.1 * kSize,
                    "spread " + std::to_string(spread) + " sample " + std::to_string(k));
}

TEST(Membrane, DerivativesAtBadStates) {
  const auto s = stencil();
  check_term<3>(elastic(s), scaled_in_plane(0.3, 0.4), 0.1 * kSize, "compressed");
  check_term<3>(elastic(s), scaled_in_plane(1, 1e-3), 1e-3 * kSize, "nearly a line");
  check_term<3>(elastic(s), scaled_in_plane(1e-3, 1e-3), 1e-3 * kSize, "nearly a point");
  check_term<3>(elastic(s), scaled_in_plane(3, 0.5), 0.1 * kSize, "torn long");
  check_term<3>(elastic(s), scaled_in_plane(-1, 1), 0.1 * kSize, "turned over");
}

TEST(Membrane, DerivativesOfMeasuredCloth) {
  // Between knots: across one the Hessian has a kink, which no difference quotient sees through.
  const MembraneStencil s = measured_stencil();
  std::mt19937 random(5);
  check_term<3>(elastic(s), scaled_in_plane(1.03, 1.045), 1e-3 * kSize, "both stretched");
  check_term<3>(elastic(s), scaled_in_plane(0.97, 1.02), 1e-3 * kSize, "pulled along warp, narrower");
  check_term<3>(elastic(s), scaled_in_plane(1.3, 1.2), 0.01 * kSize, "beyond the readings");
  check_term<3>(elastic(s), scaled_in_plane(0.4, 0.5), 0.01 * kSize, "compressed");
  for (int k = 0; k < 20; ++k)
    check_term<3>(elastic(s), perturbed<3>(scaled_in_plane(1.03, 1.04), 2e-4, random), 1e-5 * kSize,
                  "sample " + std::to_string(k));
  for (int k = 0; k < 20; ++k) {
    const StencilPoints<3> x = perturbed<3>(scaled_in_plane(1.03, 1.04), 3e-4, random);
    const StencilPoints<3> v = perturbed<3>({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1, random);
    check_derivatives<3>(dissipation(s, x), v, 1, "dissipation of measured cloth");
  }
}

TEST(Membrane, ResponseOfMeasuredClothAgreesWithTheParts) {
  std::mt19937 random(6);
  const MembraneStencil s = measured_stencil();
  const SystemWeights weights{1e-6, 1e-3, 0.3};
  const StencilPoints<3> x = perturbed<3>(scaled_in_plane(1.03, 1.04), 5e-4, random);
  const StencilPoints<3> still = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const StencilPoints<3> v = perturbed<3>(still, 0.5, random);
  StencilResponse<3> r;
  membrane_response(s, x, v, weights, r);
  const StencilVector<3> force = -weights.fabric * (membrane_gradient(s, x) + membrane_dissipation_gradient(s, x, v));
  for (int i = 0; i < 3; ++i) EXPECT_LT((r.force[i] - force.segment<3>(3 * i)).norm(), 1e-12 * force.norm());
  membrane_response(s, x, still, weights, r);
  const StencilMatrix<3> system = weights.fabric * (weights.stiffness * membrane_hessian_psd(s, x) +
                                                    weights.dissipation * membrane_dissipation_hessian(s, x));
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      EXPECT_LT((r.block[upper_block<3>(i, j)].cast<double>() - system.block<3, 3>(3 * i, 3 * j)).norm(),
                1e-6 * system.norm());
}

TEST(Membrane, StraightReadingsAreTheLinearFabric) {
  // What a linear fabric would give in the laboratory makes the same forces as its moduli, at the readings.
  Cloth linear = one_triangle(), measured = one_triangle();
  linear.fabrics[0].poisson_stiffness = 0.25 * std::sqrt(1000.0 * 600.0);
  const double warp = 1000 * (1 - 0.0625), weft = 600 * (1 - 0.0625);
  StretchTest readings;
  for (double strain : {0.01, 0.02, 0.03, 0.04}) {
    const double stretch = 1 + strain, green = 0.5 * (stretch * stretch - 1);
    readings.warp.push_back({strain, stretch * warp * green});
    readings.weft.push_back({strain, stretch * weft * green});
  }
  apply_stretch_test(readings, 0.25, "", measured.fabrics[0]);
  EXPECT_NEAR(measured.fabrics[0].stretch_stiffness.warp, 1000, 1e-9);
  EXPECT_NEAR(measured.fabrics[0].stretch_stiffness.weft, 600, 1e-9);
  EXPECT_NEAR(measured.fabrics[0].poisson_stiffness, linear.fabrics[0].poisson_stiffness, 1e-9);
  std::mt19937 random(8);
  const MembraneStencil a = membrane_stencils(linear).front(), b = membrane_stencils(measured).front();
  for (double spread : {1e-4, 1e-3}) {
    const StencilPoints<3> x = perturbed<3>(rest(), spread, random);
    EXPECT_LT((membrane_gradient(a, x) - membrane_gradient(b, x)).norm(), 1e-9 * membrane_gradient(a, x).norm());
    EXPECT_NEAR(membrane_energy(a, x), membrane_energy(b, x), 1e-9 * membrane_energy(a, x));
  }
}

TEST(Membrane, CollapsedTriangleAnswersWithFiniteNumbers) {
  const StencilPoints<3> point = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto s = stencil();
  EXPECT_TRUE(std::isfinite(membrane_energy(s, point)));
  EXPECT_TRUE(membrane_gradient(s, point).allFinite());
  EXPECT_TRUE(membrane_hessian(s, point).allFinite());
  StencilResponse<3> r;
  membrane_response(s, point, point, {1e-6, 1e-3}, r);
  for (const auto& block : r.block) EXPECT_TRUE(block.allFinite());
}

TEST(Membrane, Dissipation) {
  std::mt19937 random(2);
  const auto s = stencil();
  for (int k = 0; k < 20; ++k) {
    const StencilPoints<3> x = perturbed<3>(rest(), 2e-3, random);
    const StencilPoints<3> v = perturbed<3>({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1, random);
    check_derivatives<3>(dissipation(s, x), v, 1, "dissipation");
    // A rigid velocity dissipates nothing and meets no force.
    const Vec3 spin(3, -2, 5), drift(1, 2, 3);
    StencilPoints<3> rigid;
    for (int i = 0; i < 3; ++i) rigid[i] = spin.cross(x[i]) + drift;
    EXPECT_LT(membrane_dissipation(s, x, rigid), 1e-12 * membrane_dissipation(s, x, v));
    // Never gives energy: force · velocity = −2 R.
    EXPECT_NEAR(membrane_dissipation_gradient(s, x, v).dot(stacked<3>(v)), 2 * membrane_dissipation(s, x, v),
                1e-9 * membrane_dissipation(s, x, v));
  }
}

TEST(Membrane, PsdHessianIsExactInTension) {
  const auto s = stencil();
  const StencilPoints<3> x = scaled_in_plane(1.05, 1.03);
  EXPECT_LT((membrane_hessian(s, x) - membrane_hessian_psd(s, x)).norm(), 1e-12 * membrane_hessian(s, x).norm());
}

TEST(Membrane, ResponseAgreesWithTheParts) {
  std::mt19937 random(3);
  const auto s = stencil();
  const SystemWeights weights{1e-6, 1e-3, 0.3};
  for (double spread : {1e-4, 3e-3}) {
    const StencilPoints<3> x = perturbed<3>(rest(), spread, random);
    const StencilPoints<3> v = perturbed<3>({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 0.5, random);
    const StencilPoints<3> still = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    StencilResponse<3> r;
    membrane_response(s, x, v, weights, r);
    const StencilVector<3> force = -weights.fabric * (membrane_gradient(s, x) + membrane_dissipation_gradient(s, x, v));
    const auto plain = membrane_force(s, x, v, weights.fabric);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT((r.force[i] - force.segment<3>(3 * i)).norm(), 1e-12 * force.norm());
      EXPECT_LT((plain[i] - force.segment<3>(3 * i)).norm(), 1e-12 * force.norm());
    }
    membrane_response(s, x, still, weights, r);
    const StencilMatrix<3> system = weights.fabric * (weights.stiffness * membrane_hessian_psd(s, x) +
                                                      weights.dissipation * membrane_dissipation_hessian(s, x));
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        EXPECT_LT((r.block[upper_block<3>(i, j)].cast<double>() - system.block<3, 3>(3 * i, 3 * j)).norm(),
                  1e-6 * system.norm());
  }
}

TEST(Membrane, FlatWindingDoesNotMatter) {
  // The same cloth drawn mirrored: same energy for the mirrored image of any state.
  std::mt19937 random(4);
  StencilPoints<3> x = perturbed<3>(rest(), 2e-3, random), image = x;
  for (Vec3& p : image) p.x() = -p.x();
  EXPECT_NEAR(membrane_energy(stencil(), x), membrane_energy(stencil(true), image), 1e-12);
  EXPECT_GT(stencil(true).rest_area, 0);
}

TEST(Membrane, CompressionIsResistedDownToNothing) {
  // Uniaxial force along warp rises as the stretch falls, all the way to 0: no collapse for nothing.
  const auto s = stencil();
  double last = 0;
  for (double stretch = 0.999; stretch > 0.01; stretch -= 0.01) {
    const double dt = 1e-6;
    const double force =
        (membrane_energy(s, scaled_in_plane(1, stretch + dt)) - membrane_energy(s, scaled_in_plane(1, stretch - dt))) /
        (2 * dt * s.rest_area);
    EXPECT_LT(force, last) << stretch;
    last = force;
  }
}

TEST(Membrane, ZeroFlatAreaIsRefused) {
  Cloth cloth = one_triangle();
  cloth.flat[0][2] = cloth.flat[0][1];
  EXPECT_THROW(membrane_stencils(cloth), std::invalid_argument);
}
