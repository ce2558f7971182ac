// Elastic and drawcords in the whole simulation, against closed forms: the elastic catenary, the pressure of a band
// round a cylinder, a weight that slides on a cord.

#include "engine/mesh/sewing.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

void say(const char* what, double reference, double ours) {
  std::cout << what << ": reference " << reference << ", ours " << ours << ", error " << 100 * (ours / reference - 1)
            << " %\n";
}

/// Sag of an elastic string of relaxed length L, weight W and stiffness k between two points of one height [Irvine,
/// Cable Structures, 1981, §1.3].
double elastic_catenary_sag(double length, double span, double weight, double stiffness) {
  const auto reach = [&](double pull) {
    return pull * length / stiffness + 2 * pull * length / weight * std::asinh(weight / (2 * pull));
  };
  double low = 1e-9 * weight, high = stiffness * 10;
  for (int k = 0; k < 200; ++k) {
    const double pull = 0.5 * (low + high);
    (reach(pull) < span ? low : high) = pull;
  }
  return weight * length / (8 * stiffness) +
         low * length / weight * (std::sqrt(1 + std::pow(weight / (2 * low), 2)) - 1);
}

/// Sag of a ribbon whose two edges carry elastic and whose cloth gives way along them, `columns` edges long.
double ribbon_sag(int columns, double span, double factor, double density, double stiffness) {
  const double edge = span / columns;
  Fabric fabric = isotropic_fabric(density, 50, 1e-5, 0, 0);
  fabric.stretch_stiffness.weft = 1e-5;
  Cloth ribbon = equilateral_sheet(columns, 1, edge, fabric);
  SimulationScene scene;
  const std::vector<MeshEdge> edges = mesh_edges(ribbon.triangles);
  for (const MeshEdge& e : edges)
    if (e.triangle_count == 1 && ribbon.x[e.v0].z() == ribbon.x[e.v1].z())
      scene.trimmings.elastics.push_back(
          {{e.v0, e.v1}, factor * (ribbon.x[e.v0] - ribbon.x[e.v1]).norm(), stiffness / 2, 0.05});
  for (int v = 0; v < static_cast<int>(ribbon.x.size()); ++v)
    if (ribbon.x[v].x() < 1e-9 || ribbon.x[v].x() > span - 1e-9) scene.held.push_back({v, ribbon.x[v], nullptr});
  scene.options.max_time_step = 4e-3;
  scene.options.rest_kinetic_energy = 1e-14;
  scene.options.rest_residual = 1e-3;
  const Simulation result = simulate(ribbon, scene, [](const SimulationState&) { return true; });
  EXPECT_EQ(result.stop_reason, "at_rest");
  double lowest = 0;
  for (const Vec3& p : ribbon.x) lowest = std::min(lowest, p.y());
  return -lowest;
}

struct LoadedRing {
  double pressed = 0;  ///< sum of contact forces [N]
  double tension = 0;  ///< elastic energy [J]
};

/// A soft tube round a cylinder of 0.1 m with elastic along one end, relaxed at `factor` times the flat length.
LoadedRing ring_on_cylinder(double factor, double stiffness, bool as_cord) {
  const double radius = 0.1, offset = 2e-3, girth = 2 * std::numbers::pi * (radius + offset);
  const int columns = 48;
  const BodyField body = make_body_field(cylinder_body(radius), 0.01);
  Cloth tube =
      equilateral_sheet(columns, 2, girth / columns, isotropic_fabric(0.1, 1, 0.1, 0, 0), [&](const Vec2& uv) -> Vec3 {
        const double angle = uv.x() / (radius + offset);
        return {(radius + offset) * std::cos(angle), uv.y(), -(radius + offset) * std::sin(angle)};
      });
  tube.seam_names = {"closing"};
  for (int a = 0; a < static_cast<int>(tube.x.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(tube.x.size()); ++b)
      if ((tube.x[a] - tube.x[b]).norm() < 1e-9) tube.seam_pairs.push_back({a, b, 0});
  merge_seams(tube);
  SimulationScene scene;
  DrawcordStencil cord{{}, factor * girth, stiffness, 0.02};
  for (const MeshEdge& e : mesh_edges(tube.triangles)) {
    if (e.triangle_count != 1 || tube.x[e.v0].y() > 1e-9 || tube.x[e.v1].y() > 1e-9) continue;
    cord.segments.push_back({e.v0, e.v1});
    scene.trimmings.elastics.push_back({{e.v0, e.v1}, factor * girth / columns, stiffness, 0.02});
  }
  EXPECT_EQ(cord.segments.size(), static_cast<std::size_t>(columns));
  if (as_cord) {
    scene.trimmings.elastics.clear();
    scene.trimmings.drawcords = {cord};
  }
  scene.body = &body;
  scene.body_friction = 0;
  scene.options.body_offset = offset;
  scene.options.contact_stiffness = 1e4;
  scene.options.gravity = false;
  scene.options.rest_residual = 0;
  scene.options.simulated_time_limit = 1;
  const Simulation result = simulate(tube, scene, [](const SimulationState&) { return true; });
  LoadedRing ring;
  for (double f : result.contact_force) ring.pressed += f;
  const BackwardEuler solver(tube, scene.options, scene.trimmings);
  ring.tension = solver.energies({tube.x, Positions(tube.x.size(), Vec3::Zero())}, {}).tension;
  return ring;
}

}  // namespace

TEST(TensionReference, AnElasticRibbonHangsAsTheElasticCatenary) {
  const double span = 0.5, density = 0.4, stiffness = 0.5;
  for (double factor : {0.7, 0.95, 1.2}) {
    double error[2];
    for (int level : {0, 1}) {
      const int columns = 25 << level;
      const double weight = density * kGravity * span * (span / columns) * std::sqrt(3.0) / 2;
      const double expected = elastic_catenary_sag(factor * span, span, weight, stiffness);
      const double ours = ribbon_sag(columns, span, factor, density, stiffness);
      std::cout << columns << " edges, sewn in at " << factor << ", ";
      say("sag [m]", expected, ours);
      error[level] = std::abs(ours / expected - 1);
    }
    EXPECT_LT(error[1], 1e-3);
    EXPECT_LT(error[1], 0.5 * error[0]);
  }
}

TEST(TensionReference, ABandPressesWithItsTensionOverTheRadius) {
  const double factor = 0.8, stiffness = 10;
  const double tension = stiffness * (1 / factor - 1);
  for (bool as_cord : {false, true}) {
    const double pressed = ring_on_cylinder(factor, stiffness, as_cord).pressed;
    say(as_cord ? "force of a cord on the cylinder [N]" : "force of elastic on the cylinder [N]",
        2 * std::numbers::pi * tension, pressed);
    EXPECT_NEAR(pressed, 2 * std::numbers::pi * tension, 0.01 * 2 * std::numbers::pi * tension);
  }
}

TEST(TensionReference, ASlackBandExertsNothing) {
  for (bool as_cord : {false, true}) {
    const LoadedRing ring = ring_on_cylinder(1.05, 10, as_cord);
    EXPECT_EQ(ring.tension, 0);
    EXPECT_LT(ring.pressed, 1e-6);
  }
}

TEST(TensionReference, AWeightThatSlidesOnACordRestsAtEqualAngles) {
  // A cord of length L between two points, S apart across and D in height: cos a = S / l on either side of the weight,
  // l = L (1 + T/k), 2 T sin a = W.
  const double across = 0.4, down = 0.1, length = 0.6, stiffness = 1;
  const Fabric nothing = isotropic_fabric(1, 1e-7, 1e-7, 0, 0);
  Cloth cloth;
  cloth.x = {Vec3(0, 0, 0), Vec3(across, -down, 0), Vec3(0.1, -0.25, 0)};
  cloth.triangles = {{0, 2, 1}};
  cloth.flat = {{Vec2(0, 0), Vec2(0.1, -0.25), Vec2(across, -down)}};
  cloth.triangle_panel = {0};
  cloth.vertex_garment = {0, 0, 0};
  cloth.panels.resize(1);
  cloth.panels[0].edge_length = 0.3;
  cloth.fabrics = {nothing};
  SimulationScene scene;
  scene.held = {{0, cloth.x[0], nullptr}, {1, cloth.x[1], nullptr}};
  scene.trimmings.drawcords = {{{{0, 2}, {2, 1}}, length, stiffness, 0.02}};
  scene.options.rest_kinetic_energy = 1e-14;
  scene.options.rest_residual = 1e-3;
  scene.options.simulated_time_limit = 10;
  const Simulation result = simulate(cloth, scene, [](const SimulationState&) { return true; });
  EXPECT_EQ(result.stop_reason, "at_rest");
  const double weight = kGravity * result.mass[2];
  double stretched = length;
  for (int k = 0; k < 200; ++k) {
    const double sine = std::sqrt(1 - std::pow(across / stretched, 2));
    stretched = length * (1 + weight / (2 * sine) / stiffness);
  }
  const double sine = std::sqrt(1 - std::pow(across / stretched, 2));
  // (a + b) sin = depth below the first + depth below the second = 2 depth − D.
  const double depth = 0.5 * (stretched * sine + down);
  const double place = depth / sine * across / stretched;
  say("depth of the weight [m]", depth, -cloth.x[2].y());
  say("place across [m]", place, cloth.x[2].x());
  EXPECT_NEAR(-cloth.x[2].y(), depth, 1e-3 * depth);
  EXPECT_NEAR(cloth.x[2].x(), place, 3e-3 * place);
}
