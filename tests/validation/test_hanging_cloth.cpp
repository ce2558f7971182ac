// Cloth that hangs by its edges, through the whole engine: a catenary, and a strip longer by its own weight.

#include "engine/drape.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/references.h"

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

/// Places arc length s in [0, length] on a circular arc that hangs between two points `span` apart.
Vec3 on_arc(double s, double length, double span) {
  double low = 1e-3, high = std::numbers::pi;  // half the angle: sin(a)/a = span/length
  for (int k = 0; k < 60; ++k) {
    const double a = 0.5 * (low + high);
    (std::sin(a) / a > span / length ? low : high) = a;
  }
  const double half = low, radius = length / (2 * half), angle = (s / length - 0.5) * 2 * half;
  return {radius * std::sin(angle), -radius * (std::cos(angle) - std::cos(half)), 0};
}

}  // namespace

TEST(HangingReference, Catenary) {
  SKIP_WITHOUT_REFERENCES();
  const double length = 0.5, span = reference("/catenary/0/span") * length;
  const int rows = 50;
  const double height = length / rows, edge = height * 2 / std::sqrt(3.0);
  Fabric fabric = isotropic_fabric(0.2, 5000, 2500, 0, 1e-7);
  Cloth strip = equilateral_sheet(
      2, rows, edge, fabric, [&](const Vec2& uv) -> Vec3 { return on_arc(uv.y(), length, span) + Vec3(0, 0, uv.x()); });
  SimulationScene scene;
  Kinematic ends{std::vector<char>(strip.x.size(), 0), strip.x};
  for (std::size_t v = 0; v < strip.x.size(); ++v)
    if (std::abs(std::abs(strip.x[v].x()) - span / 2) < 1e-6 && std::abs(strip.x[v].y()) < 1e-6) {
      scene.held.push_back({static_cast<int>(v), strip.x[v], nullptr});
      ends.held[v] = 1;
    }
  ASSERT_EQ(scene.held.size(), 6u);
  scene.options.max_time_step = 2e-3;
  scene.options.rest_kinetic_energy = 1e-13;
  const Simulation result = simulate(strip, scene, [](const SimulationState&) { return true; });
  EXPECT_EQ(result.stop_reason, "at_rest");
  double lowest = 0;
  for (const Vec3& p : strip.x) lowest = std::min(lowest, p.y());
  // The supports carry what the free vertices and the ends themselves weigh.
  const BackwardEuler solver(strip, scene.options);
  const Positions force = solver.static_forces(strip.x, {});
  double horizontal = 0, weight = 0;
  for (std::size_t v = 0; v < strip.x.size(); ++v) {
    weight += kGravity * solver.masses()[v];
    if (ends.held[v] && strip.x[v].x() > 0) horizontal -= force[v].x();
  }
  const double sag = -lowest / length, pull = horizontal / weight;
  const double sag_expected = reference("/catenary/0/sag"), pull_expected = reference("/catenary/0/H_over_weight");
  std::cout << "sag / L: reference " << sag_expected << ", ours " << sag << ", error " << 100 * (sag / sag_expected - 1)
            << " %\nhorizontal pull / weight: reference " << pull_expected << ", ours " << pull << ", error "
            << 100 * (pull / pull_expected - 1) << " %\n";
  EXPECT_NEAR(sag, sag_expected, 0.005 * sag_expected);
  EXPECT_NEAR(pull, pull_expected, 0.005 * pull_expected);
}

TEST(HangingReference, AMeshedPanelHangsAsLongAsItsWeightMakesIt) {
  SKIP_WITHOUT_REFERENCES();
  for (double ratio : {0.001, 0.01, 0.05, 0.2}) {
    const double length = 0.5, density = 0.2;
    Scene scene;
    scene.garments = {garment_of(Pattern{{rectangle_panel("strip", 0.08, length)}, {}}, 0.01)};
    Garment& garment = scene.garments[0];
    garment.fabric = isotropic_fabric(density, density * kGravity * length / ratio, 20, 0, 1e-7);
    garment.fabric.membrane_damping = 5e-2;
    garment.pins = {{PinEdge{0, 2}, PinFixed{}}};
    scene.solver.rest_kinetic_energy = 1e-13;
    scene.solver.rest_residual = 1e-4;  // 0.1 % of so small an elongation needs better forces than a drape does
    scene.solver.max_time_step = 5e-3;
    CountingMonitor monitor;
    const Drape result = drape(scene, monitor);
    EXPECT_EQ(result.report.status, "converged");
    double end = 0;
    int count = 0;
    for (const LabelledVertices& l : result.cloth.labels)
      if (l.label == "strip/0")
        for (int v : l.vertices) end -= result.cloth.x[v].y(), ++count;
    ASSERT_GT(count, 0);
    const double elongation = end / count / length;
    const int row = reference_row("/membrane_stvk/hanging", "rhogL_over_Y", ratio);
    const double expected = reference("/membrane_stvk/hanging/" + std::to_string(row) + "/stvk");
    std::cout << "elongation at rho g L / Y = " << ratio << ": reference " << expected << ", ours " << elongation
              << ", error " << 100 * (elongation / expected - 1) << " %\n";
    EXPECT_NEAR(elongation, expected, 0.002 * expected);
  }
}
