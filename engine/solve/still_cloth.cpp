#include "engine/solve/still_cloth.h"

#include "engine/solve/backward_euler.h"
#include "engine/solve/clamps.h"
#include "engine/solve/trim_touching.h"
#include "engine/terms/bending.h"

#include <algorithm>

namespace toile {

namespace {

/// The cloth with its clamps' points where they are at the end, its bending without friction.
Cloth with_clamps(const Cloth& cloth, const Positions& start, const std::vector<HeldVertex>& held) {
  Cloth clamped = cloth;
  clamped.x = start;
  for (Fabric& fabric : clamped.fabrics) fabric.bending_hysteresis = {};
  const std::vector<HeldVertex> points = add_clamps(clamped, held);
  std::copy(cloth.x.begin(), cloth.x.end(), clamped.x.begin());
  for (const HeldVertex& point : points) clamped.x[point.vertex] = position_at(point, last_key_frame(held));
  return clamped;
}

std::vector<FrictionMoment> friction_moments(const Cloth& clamped) {
  std::vector<FrictionMoment> moments;
  const BendingStencils bending = bending_stencils(clamped);
  for (std::size_t k = 0; k < bending.laws.size(); ++k) {
    if (!(bending.laws[k].onset > 0)) continue;
    const BendingStencil& s = bending.stencils[k];
    StencilPoints<6> x;
    for (std::size_t i = 0; i < 6; ++i) x[i] = clamped.x[s.nodes[i]];
    moments.push_back({s.nodes, bending_friction_arm(s, bending.laws[k], x)});
  }
  return moments;
}

constexpr double kTrimStep = 0.02;  // [s] long beside a thread's vibrations: a step is nearly one of Newton's method
constexpr int kTrimSteps = 200;     // at most
constexpr double kTrimResidual = 1e-4;  // of its weight

struct TrimsAtRest {
  std::vector<RigidState> states;
  std::vector<TrimContact> contacts;
  bool found = true;
};

/// Where rigid trims come to rest while the cloth is held, beginning where they are sewn on.
TrimsAtRest rest_trims(const Cloth& cloth, const Cloth& clamped, const SimulationScene& scene) {
  TrimsAtRest rest;
  const std::vector<RigidTrim>& trims = scene.trimmings.trims;
  if (trims.empty()) return rest;
  SolverOptions options = scene.options;
  options.newton_tolerance = 1e-9;
  options.newton_momentum_fraction = 1e-5;
  options.newton_iterations = 20;
  BackwardEuler solver(clamped, options, scene.trimmings);
  const TrimTouching touching(cloth, trims, touching_options(scene));
  const std::size_t n = clamped.x.size();
  State state{clamped.x, Positions(n, Vec3::Zero()), {}};
  for (const RigidTrim& trim : trims) state.trims.push_back(trim.start);
  const Kinematic kinematic{std::vector<char>(n, 1), clamped.x};
  StepTimes times;
  std::vector<Contact> none;
  for (int step = 0; step < kTrimSteps; ++step) {
    rest.contacts = touching.detect(state.x, state.trims);
    for (TrimContact& c : rest.contacts) c.contact.friction = 0;
    const Positions force = solver.static_forces(state.x, {}, state.trims, rest.contacts);
    rest.found = true;
    for (std::size_t t = 0; t < trims.size(); ++t) {
      const double left = std::max(force[n + 2 * t].norm(), force[n + 2 * t + 1].norm());
      rest.found = rest.found && left < kTrimResidual * trims[t].body.mass * kGravity;
    }
    if (rest.found || !solver.step(state, kTrimStep, 1, none, kinematic, times, &rest.contacts).accepted) break;
    for (RigidState& trim : state.trims) trim.velocity = trim.angular_velocity = Vec3::Zero();
  }
  rest.states = state.trims;
  return rest;
}

}  // namespace

StillCloth still_cloth(const Cloth& cloth, const Positions& start, const SimulationScene& scene) {
  Cloth clamped = with_clamps(cloth, start, scene.held);
  const BackwardEuler solver(clamped, scene.options, scene.trimmings);
  Touching touching(cloth, touching_options(scene));
  StillCloth still;
  still.mass = solver.masses();
  still.contacts = touching.detect(cloth.x);
  still.cloth_contacts = touching.cloth_contacts();
  still.contact_distance = touching.contact_distance();
  const TrimsAtRest trims = rest_trims(cloth, clamped, scene);
  still.trims_rest = trims.found;
  still.force = solver.static_forces(clamped.x, {}, trims.states, trims.contacts);
  still.energies = solver.energies_by_term(clamped.x, trims.states, trims.contacts);
  clamped.fabrics = cloth.fabrics;
  still.friction_moments = friction_moments(clamped);
  still.mass.resize(cloth.x.size());
  still.force.resize(cloth.x.size());
  return still;
}

}  // namespace toile
