// A heavy strip clamped at one end against the elastica and against the discrete chain.

#include "engine/solve/backward_euler.h"
#include "tests/engine/solve/sheets.h"
#include "tests/validation/references.h"

using namespace toile;
using namespace toile::test;

namespace {

struct Tip {
  double x, drop;  ///< over the overhang
};

/// Drapes a strip of `cells` rows beyond its clamp at Γ = ρ g L³/D. The first two rows of vertices are held. With the
/// half clamp the row of triangles between them is a panel three times as stiff, so that the hinge in the clamp, which
/// stands for half a cell, has twice the stiffness of the others.
Tip cantilever(double gamma, int cells, bool half_clamp) {
  const double length = 0.05, height = length / cells, edge = height * 2 / std::sqrt(3.0), density = 0.2;
  const double bending = density * kGravity * length * length * length / gamma;
  Fabric fabric = isotropic_fabric(density, 2000, 700, 600, bending);
  fabric.bending_damping = 5e-3;
  fabric.membrane_damping = 1e-3;
  const auto place = [&](const Vec2& uv) { return Vec3(uv.y() - height, 0, uv.x()); };
  Cloth strip = equilateral_sheet(static_cast<int>(0.03 / edge), cells + 1, edge, fabric, place);
  if (half_clamp) {
    Fabric stiff = fabric;
    stiff.bending_stiffness = {3 * bending, 3 * bending, 3 * bending};
    strip.fabrics.push_back(stiff);
    strip.panels.push_back(strip.panels[0]);
    strip.panels[1].fabric = 1;
    for (std::size_t t = 0; t < strip.triangles.size(); ++t) {
      double furthest = -1;
      for (int v : strip.triangles[t]) furthest = std::max(furthest, strip.x[v].x());
      if (furthest < 0.5 * height) strip.triangle_panel[t] = 1;
    }
  }
  SolverOptions options;
  options.air_drag = 2;
  BackwardEuler solver(strip, options);
  State state{strip.x, Positions(strip.x.size(), Vec3::Zero())};
  Kinematic kinematic{std::vector<char>(strip.x.size(), 0), strip.x};
  for (std::size_t i = 0; i < strip.x.size(); ++i) kinematic.held[i] = strip.x[i].x() < 0.5 * height;
  std::vector<Contact> none;
  StepTimes times;
  for (int k = 0; k < 1500; ++k) EXPECT_TRUE(solver.step(state, 2e-3, 1, none, kinematic, times).accepted) << k;
  Vec3 end = Vec3::Zero();
  int count = 0;
  for (std::size_t i = 0; i < strip.x.size(); ++i)
    if (strip.x[i].x() > length - 0.5 * height) {
      end += state.x[i];
      ++count;
    }
  end /= count;
  return {end.x() / length, -end.y() / length};
}

std::string chain_row(double gamma, int n, bool half) {
  // Rows come in the order of (gamma, n, clamp): full, half.
  for (int row = reference_row("/discrete_chain", "Gamma", gamma);; row += 2) {
    const std::string at = "/discrete_chain/" + std::to_string(row);
    if (reference(at + "/n") == n) return "/discrete_chain/" + std::to_string(row + half);
  }
}

}  // namespace

TEST(CantileverReference, HingesAreTheDiscreteChain) {
  SKIP_WITHOUT_REFERENCES();
  for (bool half : {false, true}) {
    const Tip tip = cantilever(10, 20, half);
    const std::string at = chain_row(10, 20, half);
    EXPECT_NEAR(tip.x, reference(at + "/x"), 5e-3) << half;
    EXPECT_NEAR(tip.drop, reference(at + "/drop"), 5e-3) << half;
  }
}

TEST(CantileverReference, ProperClampGivesTheElastica) {
  SKIP_WITHOUT_REFERENCES();
  for (double gamma : {1.0, 10.0, 50.0}) {
    const Tip tip = cantilever(gamma, 20, true);
    const std::string at = "/cantilever/" + std::to_string(reference_row("/cantilever", "Gamma", gamma));
    EXPECT_NEAR(tip.x, reference(at + "/x"), 0.01) << gamma;
    EXPECT_NEAR(tip.drop, reference(at + "/drop"), 0.01) << gamma;
  }
}
