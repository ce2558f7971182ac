// Zippers in the whole engine: what hangs by one hangs with its weight, closed where it is closed; and a tape as a
// beam.

#include "engine/mesh/sewing.h"
#include "engine/mesh/zippers.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

/// Two halves of a front, 0.12 m by 0.3 m each, that meet in a zipper and hang by the middles of their tops, whose pins
/// draw the tops apart: an open front.
Scene open_front(double closed_fraction) {
  Scene scene = zipped_halves(0.12, 0.3, 0.3, 4e-3, closed_fraction, 1);
  for (const double side : {-1.0, 1.0})
    scene.garments[0].pins.push_back(
        {PinBox{Vec3(side * 0.06 - 0.065, 1.2999, -1), Vec3(side * 0.06 + 0.065, 1.31, 1)},
         PinMoved{Vec3::Zero(), {{0.1, Vec3::Zero(), Vec3::Zero()}, {0.5, Vec3(side * 0.02, 0, 0), Vec3::Zero()}}}});
  scene.solver.rest_kinetic_energy = 1e-12;
  scene.solver.rest_residual = 2e-3;
  return scene;
}

}  // namespace

TEST(ZipperReference, AnOpenFrontHangsByItsWeightClosedToTheSliderAndFreeAboveIt) {
  const Scene scene = open_front(0.6);
  Cloth front = build_cloth(scene);
  const double gap_before = seam_gap_max(front);
  merge_seams(front);
  SimulationScene simulated;
  simulated.options = scene.solver;
  simulated.held = held_vertices(scene, front, {});
  simulated.trimmings = make_trimmings(scene, front);
  const Simulation result = simulate(front, simulated, [](const SimulationState&) { return true; });
  EXPECT_EQ(result.stop_reason, "at_rest");
  const auto sides = zipper_sides(front, 0, 0);
  const std::size_t segments = sides[0].size() - 1;
  double closed = 0, open = 0;
  for (std::size_t i = 0; i <= segments; ++i) {
    double& widest = 5 * i <= 3 * segments ? closed : open;
    widest = std::max(
        widest,
        (front.x[static_cast<std::size_t>(sides[0][i])] - front.x[static_cast<std::size_t>(sides[1][i])]).norm());
  }
  std::cout << "closed part: reference 0 mm, ours " << 1e3 * closed << " mm (" << 1e3 * gap_before
            << " mm as placed); open part " << 1e3 * open << " mm wide\n";
  EXPECT_LT(closed, 1e-3);
  EXPECT_GT(open, 0.02);
  EXPECT_EQ(self_intersections(front.x, front.triangles).size(), 0u);

  double mass = 0, ends = 0;
  for (const double m : result.mass) mass += m;
  for (const RigidTrim& trim : simulated.trimmings.trims) ends += trim.body.mass;
  EXPECT_NEAR(mass, 2 * 0.12 * 0.3 * scene.garments[0].fabric.area_density + 0.3 * 0.02, 1e-9);
  EXPECT_NEAR(ends, 2.5e-3 + 3 * 0.2e-3, 1e-12);
  const BackwardEuler solver(front, simulated.options, simulated.trimmings);
  const Positions force = solver.static_forces(front.x, result.contacts, result.trims, result.trim_contacts);
  Vec3 carried = Vec3::Zero();
  for (const HeldVertex& held : simulated.held) carried -= force[static_cast<std::size_t>(held.vertex)];
  const double weight = (mass + ends) * kGravity;
  std::cout << "carried by the pins (at rest after " << result.time << " s): reference " << weight << " N, ours "
            << carried.y() << ", error over weight " << (carried / weight - Vec3::UnitY()).norm() << '\n';
  EXPECT_LT((carried - weight * Vec3::UnitY()).norm(), 1e-3 * weight);
}

TEST(ZipperReference, ATapeHeldLevelDroopsAsABeam) {
  // Cloth that weighs next to nothing and hardly resists, held level by one end of its tape: w L⁴/(8 B). Two held
  // vertices hold the tangent from the middle of their edge on (pinned rows make a clamp that is half an edge too
  // soft).
  double last = 0;
  for (const double edge : {0.02, 0.01, 0.005}) {
    const double length = 0.1;
    const Fabric thin = isotropic_fabric(1e-5, 1, 0.1, 0.1, 1e-9);
    const int columns = static_cast<int>(std::lround(length / edge)) + 1;
    Cloth strip = equilateral_sheet(columns, 2, edge, thin);
    Trimmings trimmings;
    std::vector<int> line;
    for (std::size_t v = 0; v < strip.x.size(); ++v)
      if (strip.x[v].z() < 1e-9) line.push_back(static_cast<int>(v));
    ASSERT_EQ(line.size(), static_cast<std::size_t>(columns) + 1);
    const double bending = 4e-3, per_length = 0.02;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      for (const int node : {line[k], line[k + 1]}) trimmings.masses.push_back({node, 0.5 * per_length * edge});
      trimmings.elastics.push_back({{line[k], line[k + 1]}, edge, 2000, 0.02});
      if (k > 0) trimmings.tapes.push_back({{line[k - 1], line[k], line[k + 1]}, edge, bending, 0.1});
    }
    SimulationScene scene;
    scene.trimmings = trimmings;
    scene.options.relaxation_time = 0;
    scene.options.rest_kinetic_energy = 1e-20;
    scene.options.rest_residual = 0;
    scene.options.newton_tolerance = 1e-10;
    scene.options.newton_momentum_fraction = 1e-3;
    scene.options.newton_iterations = 20;
    scene.options.air_drag = 20;
    scene.options.simulated_time_limit = 3;
    for (const int v : {line[0], line[1]}) scene.held.push_back({v, strip.x[static_cast<std::size_t>(v)], nullptr});
    const Simulation result = simulate(strip, scene, [](const SimulationState&) { return true; });
    const double beam = length + 0.5 * edge, load = per_length * kGravity;
    const double reference = load * std::pow(beam, 4) / (8 * bending);
    const double ours = -strip.x[static_cast<std::size_t>(line.back())].y(), error = std::abs(ours / reference - 1);
    std::cout << "edge " << 1e3 * edge << " mm (" << result.stop_reason << "): reference " << 1e3 * reference
              << " mm, ours " << 1e3 * ours << ", error " << 100 * error << " %"
              << (last > 0 ? ", order " + std::to_string(std::log2(last / error)) : "") << '\n';
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 1.5);
    }
    last = error;
  }
  EXPECT_LT(last, 0.005);
}
