#include "engine/terms/bending.h"

#include "engine/geometry/dihedral.h"
#include "tests/engine/terms/check_term.h"

#include <numbers>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kEdge = 0.01;  ///< [m]

/// Two equilateral triangles that share the edge 0 1, folded by `degrees`.
StencilPoints<4> folded(double degrees) {
  const double a = degrees * std::numbers::pi / 180, height = kEdge * std::sqrt(3.0) / 2;
  return {Vec3(0, 0, 0), Vec3(kEdge, 0, 0), Vec3(0.5 * kEdge, height, 0),
          Vec3(0.5 * kEdge, -height * std::cos(a), -height * std::sin(a))};
}

BendingStencil hinge() { return {{0, 1, 2, 3}, 1e-5, 0.2, 0.1}; }

Potential<4> elastic(const BendingStencil& s) {
  return {[=](const auto& x) { return bending_energy(s, x); }, [=](const auto& x) { return bending_gradient(s, x); },
          [=](const auto& x) { return bending_hessian(s, x); },
          [=](const auto& x) { return bending_hessian_psd(s, x); }};
}

Potential<4> dissipation(const BendingStencil& s, const StencilPoints<4>& x) {
  return {[=](const auto& v) { return bending_dissipation(s, x, v); },
          [=](const auto& v) { return bending_dissipation_gradient(s, x, v); },
          [=](const auto&) { return bending_dissipation_hessian(s, x); },
          [=](const auto&) { return bending_dissipation_hessian(s, x); }};
}

/// Two flat triangles of one fabric around an edge along weft; `turned`: the second is wound the other way round.
Cloth two_triangles(bool turned, const Directional& bending) {
  Cloth cloth;
  const double height = kEdge * std::sqrt(3.0) / 2;
  const std::array<Vec2, 4> flat = {Vec2(0, 0), Vec2(kEdge, 0), Vec2(0.5 * kEdge, height), Vec2(0.5 * kEdge, -height)};
  const auto add = [&](int a, int b, int c) {
    cloth.triangles.push_back({a, b, c});
    cloth.flat.push_back({flat[a], flat[b], flat[c]});
  };
  add(0, 1, 2);
  turned ? add(0, 1, 3) : add(1, 0, 3);
  for (const Vec2& p : flat) cloth.x.emplace_back(p.x(), p.y(), 0);
  cloth.triangle_panel = {0, 0};
  cloth.panels.resize(1);
  Fabric f;
  f.bending_stiffness = bending;
  cloth.fabrics = {f};
  return cloth;
}

}  // namespace

TEST(Bending, DerivativesAtRest) {
  const double degrees = hinge().rest_angle * 180 / std::numbers::pi;
  const StencilPoints<4> x =
      folded(dihedral_angle(folded(1)[0], folded(1)[1], folded(1)[2], folded(1)[3]) > 0 ? degrees : -degrees);
  check_term<4>(elastic(hinge()), x, kEdge, "rest");
  EXPECT_LT(bending_energy(hinge(), x), 1e-20);
}

TEST(Bending, DerivativesAtRandomStates) {
  std::mt19937 random(1);
  for (double spread : {1e-4, 1e-3})
    for (int k = 0; k < 20; ++k)
      check_term<4>(elastic(hinge()), perturbed<4>(folded(30), spread, random), 0.2 * kEdge, "random");
}

TEST(Bending, DerivativesWhenFolded) {
  for (double degrees : {-179.0, -150.0, -90.0, 90.0, 170.0, 179.0})
    check_term<4>(elastic(hinge()), folded(degrees), 0.01 * kEdge, std::to_string(degrees));
}

TEST(Bending, DerivativesNearDegenerate) {
  StencilPoints<4> x = folded(40);
  x[2] = Vec3(0.3 * kEdge, 1e-3 * kEdge, 0);  // a triangle a thousandth as high as it is long
  check_term<4>(elastic(hinge()), x, 1e-3 * kEdge, "sliver");
  x = folded(40);
  x[1] = Vec3(1e-3 * kEdge, 0, 0);  // a short shared edge
  check_term<4>(elastic(hinge()), x, 1e-3 * kEdge, "short edge");
}

TEST(Bending, CollapsedHingeAnswersWithNothing) {
  StencilPoints<4> x = folded(40);
  x[2] = 0.5 * (x[0] + x[1]);
  BendingResponse r;
  bending_response(hinge(), x, x, {1e-6, 1e-3}, r);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(r.force[i].norm(), 0);
    EXPECT_EQ(r.row[i].norm(), 0);
  }
}

TEST(Bending, Dissipation) {
  std::mt19937 random(2);
  for (int k = 0; k < 20; ++k) {
    const StencilPoints<4> x = perturbed<4>(folded(50), 1e-3, random);
    const StencilPoints<4> v =
        perturbed<4>(StencilPoints<4>{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1, random);
    check_derivatives<4>(dissipation(hinge(), x), v, 1, "dissipation");
    const Vec3 spin(3, -2, 5), drift(1, 2, 3);
    StencilPoints<4> rigid;
    for (int i = 0; i < 4; ++i) rigid[i] = spin.cross(x[i]) + drift;
    EXPECT_LT(bending_dissipation(hinge(), x, rigid), 1e-12 * bending_dissipation(hinge(), x, v));
  }
}

TEST(Bending, ResponseAgreesWithTheParts) {
  std::mt19937 random(3);
  const SystemWeights weights{1e-6, 1e-3, 0.3};
  const StencilPoints<4> x = perturbed<4>(folded(50), 1e-3, random);
  const StencilPoints<4> v =
      perturbed<4>(StencilPoints<4>{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, 1, random);
  BendingResponse r;
  bending_response(hinge(), x, v, weights, r);
  const StencilVector<4> force =
      -weights.fabric * (bending_gradient(hinge(), x) + bending_dissipation_gradient(hinge(), x, v));
  const auto plain = bending_force(hinge(), x, v, weights.fabric);
  const StencilMatrix<4> system = weights.fabric * (weights.stiffness * bending_hessian_psd(hinge(), x) +
                                                    weights.dissipation * bending_dissipation_hessian(hinge(), x));
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((r.force[i] - force.segment<3>(3 * i)).norm(), 1e-12 * force.norm());
    EXPECT_LT((plain[i] - force.segment<3>(3 * i)).norm(), 1e-12 * force.norm());
    for (int j = 0; j < 4; ++j)
      EXPECT_LT(((r.row[i] * r.row[j].transpose()).cast<double>() - system.block<3, 3>(3 * i, 3 * j)).norm(),
                1e-6 * system.norm());
  }
}

TEST(Bending, CoefficientIsTheTextilesCylindricalStiffness) {
  // k = D l² / (A₀ + A₁) = D l² / (√3/2 l²)
  const auto s = bending_stencils(two_triangles(false, {3e-6, 3e-6, 3e-6}));
  ASSERT_EQ(s.size(), 1u);
  EXPECT_NEAR(s[0].stiffness, 3e-6 * 2 / std::sqrt(3.0), 1e-18);
}

TEST(Bending, TurnedWindingGivesTheSameHinge) {
  for (double degrees : {-120.0, -10.0, 10.0, 120.0}) {
    const StencilPoints<4> x = folded(degrees);
    double energy[2];
    for (bool turned : {false, true}) {
      const auto s = bending_stencils(two_triangles(turned, {3e-6, 3e-6, 3e-6})).front();
      energy[turned] = bending_energy(s, {x[s.nodes[0]], x[s.nodes[1]], x[s.nodes[2]], x[s.nodes[3]]});
      const double angle = degrees * std::numbers::pi / 180;
      EXPECT_NEAR(energy[turned], 0.5 * s.stiffness * angle * angle, 1e-12 * s.stiffness);
    }
    EXPECT_DOUBLE_EQ(energy[0], energy[1]);
  }
}

TEST(Bending, EdgeAlongWeftBendsTheWarp) {
  const Directional bending{9e-6, 2e-6, 5.5e-6};  // bias midway: no fourth harmonic
  const auto s = bending_stencils(two_triangles(false, bending)).front();
  // The edge lies along weft, so its normal is warp: d₀ − 3/2 d₂ = 5.5 + 1.5 · 3.5.
  EXPECT_NEAR(s.stiffness * std::sqrt(3.0) / 2, (5.5 + 1.5 * 3.5) * 1e-6, 1e-12);
}

TEST(Bending, DirectionalLaw) {
  const Directional bending{9e-6, 7e-6, 8.5e-6};
  const double right = std::numbers::pi / 2;
  EXPECT_DOUBLE_EQ(hinge_bending_stiffness({4e-6, 4e-6, 4e-6}, 0.3), 4e-6);
  EXPECT_DOUBLE_EQ(hinge_bending_stiffness(bending, right / 2), 8.5e-6);
  EXPECT_NEAR(hinge_bending_stiffness(bending, 0.7), hinge_bending_stiffness(bending, 0.7 + 2 * right), 1e-18);
  EXPECT_NEAR(hinge_bending_stiffness(bending, 0.7), hinge_bending_stiffness(bending, -0.7), 1e-18);
  EXPECT_GE(hinge_bending_stiffness({1e-4, 1e-7, 1e-7}, 0), 1e-8);

  // What a lattice of three edge directions makes of it, averaged over orientations: warp and weft as measured (up to
  // the fourth harmonic, here d₄ = −0.25e-6, of which it passes a sixth).
  double warp = 0, weft = 0;
  const int samples = 60;
  for (int k = 0; k < samples; ++k)
    for (int e = 0; e < 3; ++e) {
      const double normal = (k + 0.5) / samples * right * 2 / 3 + e * right * 2 / 3;
      const double d = hinge_bending_stiffness(bending, normal) * 8.0 / 9 / samples;
      warp += d * std::pow(std::cos(normal - right), 4);
      weft += d * std::pow(std::cos(normal), 4);
    }
  EXPECT_NEAR(warp - weft, 2e-6, 1e-9);
  EXPECT_NEAR(warp + weft, 16e-6 + 2 * 0.25e-6 * 5 / 6, 1e-9);
}
