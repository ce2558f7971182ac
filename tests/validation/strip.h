#pragma once
// A strip of cloth clamped along its short edge, and its way to rest.

#include "engine/mesh/build_cloth.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/clamps.h"
#include "tests/engine/solve/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::test {

/// Where the strip starts: along +x, right side up (level), or along +y (upright).
struct StripScene {
  double length = 0.1, width = 0.025, edge = 0.0025;  ///< [m]
  double degrees = 0;                                 ///< from weft to the strip's length
  bool upright = false;
  double bow = 0;  ///< height of its tip over its start line, as a share of the length
};

/// [0, length] × [0, width] as a panel of the panel mesher, clamped at the start of its length.
inline Scene strip_scene(const StripScene& s, const Fabric& fabric) {
  const double angle = s.degrees * std::numbers::pi / 180;
  const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  Panel panel;
  panel.name = "strip";
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
    panel.vertices.emplace_back(u * s.length * along + v * s.width * across);
  for (int k = 0; k < 4; ++k) panel.edges.push_back({k, (k + 1) % 4, StraightEdge{}, ""});
  Mat3 pattern, world;
  pattern << along, across, Vec2::Zero(), 0, 0, 1;
  world << Vec3::UnitX(), -Vec3::UnitZ(), Vec3::UnitY();
  if (s.upright) world << Vec3::UnitY(), -Vec3::UnitZ(), -Vec3::UnitX();
  panel.rotation = world * pattern.transpose();
  Scene scene;
  scene.garments = {garment_of(Pattern{{panel}, {}}, s.edge, "strip")};
  scene.garments[0].fabric = fabric;
  scene.garments[0].pins = {{PinEdge{0, 3}, PinFixed{}, true}};
  return scene;
}

/// A cloth with its clamps, and what holds it.
struct HeldCloth {
  Cloth cloth;
  std::vector<HeldVertex> held;
  int vertices;  ///< without the clamps' points
};

inline HeldCloth held_cloth(const Scene& scene) {
  HeldCloth result{build_cloth(scene), {}, 0};
  result.vertices = static_cast<int>(result.cloth.x.size());
  result.held = held_vertices(scene, result.cloth, {});
  const std::vector<HeldVertex> points = add_clamps(result.cloth, result.held);
  result.held.insert(result.held.end(), points.begin(), points.end());
  return result;
}

inline HeldCloth make_strip(const StripScene& s, const Fabric& fabric) {
  HeldCloth strip = held_cloth(strip_scene(s, fabric));
  for (int v = 0; v < strip.vertices; ++v) {
    Vec3& x = strip.cloth.x[v];
    const double share = (s.upright ? x.y() : x.x()) / s.length;
    (s.upright ? x.x() : x.y()) += s.bow * s.length * share * share;
  }
  return strip;
}

struct Rest {
  double residual = 1;  ///< root mean square of net force over nodal weight, free vertices
  int steps = 0;
  Energies energies;
};

/// Comes to rest by the engine's own steps, with the velocity taken away whenever the kinetic energy falls (kinetic
/// damping), until the net force on free vertices is this share of their weight.
inline Rest settle(BackwardEuler& solver, HeldCloth& cloth, double step = 0.01, int most_steps = 1500,
                   double tolerance = 1e-3) {
  State state{cloth.cloth.x, Positions(cloth.cloth.x.size(), Vec3::Zero())};
  Kinematic kinematic{std::vector<char>(state.x.size(), 0), state.x};
  for (const HeldVertex& h : cloth.held) kinematic.held[h.vertex] = 1;
  std::vector<Contact> none;
  StepTimes times;
  Rest rest;
  double h = step, last_energy = 0;
  for (; rest.steps < most_steps && rest.residual > tolerance; ++rest.steps) {
    if (!solver.step(state, h, 1, none, kinematic, times).accepted) {
      h *= 0.5;
      if (h < 1e-7) break;
      continue;
    }
    h = std::min(1.1 * h, step);
    double energy = 0;
    for (double e : solver.kinetic_energy(state)) energy += e;
    if (energy < last_energy) std::fill(state.v.begin(), state.v.end(), Vec3::Zero());
    last_energy = energy < last_energy ? 0 : energy;
    if (rest.steps % 5 != 0) continue;
    const Positions force = solver.static_forces(state.x, none);
    double sum = 0;
    int count = 0;
    for (int v = 0; v < cloth.vertices; ++v) {
      if (kinematic.held[v]) continue;
      sum += force[v].squaredNorm() / std::pow(solver.masses()[v] * kGravity, 2);
      ++count;
    }
    rest.residual = std::sqrt(sum / count);
  }
  cloth.cloth.x = state.x;
  rest.energies = solver.energies(state, none);
  return rest;
}

inline Rest settle(HeldCloth& cloth, double tolerance = 1e-3) {
  SolverOptions options;
  options.air_drag = 0;
  options.newton_momentum_fraction = tolerance;
  options.newton_iterations = 10;
  BackwardEuler solver(cloth.cloth, options);
  return settle(solver, cloth, 0.01, 1500, tolerance);
}

/// Mean position of the strip's free end.
inline Vec3 tip_of(const HeldCloth& cloth) {
  for (const LabelledVertices& label : cloth.cloth.labels)
    if (label.label == "strip/1") {
      Vec3 sum = Vec3::Zero();
      for (int v : label.vertices) sum += cloth.cloth.x[v];
      return sum / static_cast<double>(label.vertices.size());
    }
  return Vec3::Constant(std::nan(""));
}

/// Without Poisson's ratio, and hardly stretching. No damping: settling takes the velocity away.
inline Fabric strip_fabric(double density, const Directional& bending) {
  Fabric f = isotropic_fabric(density, 500, 250, 0, 0);
  f.bending_stiffness = bending;
  f.bending_damping = f.membrane_damping = 0;
  return f;
}

inline double bending_at(double gamma, double density, double length) {
  return density * kGravity * length * length * length / gamma;
}

}  // namespace toile::test
