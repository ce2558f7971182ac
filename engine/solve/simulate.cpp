#include "engine/solve/simulate.h"

#include "engine/contact/body_contacts.h"
#include "engine/contact/friction_memory.h"
#include "engine/contact/proximity.h"
#include "engine/monitor.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/clamps.h"
#include "engine/solve/relaxation.h"
#include "engine/solve/rest.h"
#include "engine/solve/time_step.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace toile {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kForceCheckInterval = 0.01;  // [s]
constexpr double kListRadius = 5e-3;          // [m] at least: lets fine meshes fall at over a metre a second

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Finds what touches, and remembers friction from step to step. Positions may have more points than the cloth has
/// vertices (clamps'), which touch nothing.
class Touching {
 public:
  Touching(const Cloth& cloth, const SimulationScene& scene)
      : proximity_(make_collision_mesh(cloth, scene.options.contact_distance), kListRadius),
        body_(scene.body),
        vertices_(static_cast<long>(cloth.x.size())) {
    double friction = 0;
    for (const Fabric& fabric : cloth.fabrics) friction = std::max(friction, fabric.friction_body);
    body_options_.friction = scene.body_friction >= 0 ? scene.body_friction : friction;
    body_options_.offset = scene.options.body_offset;
    if (body_options_.offset > 0) return;
    for (const ClothPanel& panel : cloth.panels)
      body_options_.offset =
          std::max(body_options_.offset, default_body_offset(cloth.fabrics[panel.fabric].thickness, panel.edge_length));
  }

  std::vector<Contact> detect(const Positions& points) {
    const Positions x = vertices_of(points);
    proximity_.update(x);
    std::vector<Contact> contacts = proximity_.contacts();
    if (body_) {
      const std::vector<Contact> more = body_contacts(proximity_.mesh(), *body_, x, body_options_);
      contacts.insert(contacts.end(), more.begin(), more.end());
    }
    memory_.recall(contacts, x);
    return contacts;
  }

  /// Cuts short the moves since detect() that could have crossed cloth; returns their number.
  long limit(const Positions& from, Positions& to) const {
    Positions moved = vertices_of(to);
    const long limited = limit_displacements(vertices_of(from), proximity_.displacement_bounds(), moved);
    std::copy(moved.begin(), moved.end(), to.begin());
    return limited;
  }

  void remember(const std::vector<Contact>& contacts, const Positions& x) { memory_.store(contacts, x); }

 private:
  Positions vertices_of(const Positions& points) const { return {points.begin(), points.begin() + vertices_}; }

  Proximity proximity_;
  const BodyField* body_;
  long vertices_;
  BodyContactOptions body_options_;
  FrictionMemory memory_;
};

/// Of the net force over nodal weight, on free vertices.
double rms_residual(const Positions& force, const std::vector<double>& mass, const std::vector<char>& held) {
  double sum = 0;
  long count = 0;
  for (std::size_t v = 0; v < force.size(); ++v) {
    if (held[v] || mass[v] <= 0) continue;
    sum += force[v].squaredNorm() / std::pow(mass[v] * kGravity, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

bool finite(const Positions& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); });
}

}  // namespace

double estimated_progress(const SimulationState& state, const SolverOptions& options) {
  return std::max(state.time / (state.time + 1.0), state.time / options.simulated_time_limit);
}

Simulation simulate(Cloth& cloth, const SimulationScene& scene, const SimulationProgress& progress) {
  const SolverOptions& options = scene.options;
  Simulation result;
  Touching touching(cloth, scene);
  Cloth clamped = cloth;
  std::vector<HeldVertex> held_points = scene.held;
  const std::vector<HeldVertex> clamp_points = add_clamps(clamped, scene.held);
  held_points.insert(held_points.end(), clamp_points.begin(), clamp_points.end());
  BackwardEuler solver(clamped, options);
  const std::size_t vertices = cloth.x.size(), n = clamped.x.size();
  TimeStep time_step(options);
  RestDetector rest(options);
  StepTimes step_times;
  State state{clamped.x, Positions(n, Vec3::Zero())};
  Kinematic kinematic{std::vector<char>(n, 0), clamped.x};
  for (const HeldVertex& held : held_points) kinematic.held[held.vertex] = 1;
  const double moving_until = std::max(last_key_frame(scene.held), options.relaxation_time);

  double t = 0, next_force_check = 0;
  bool balanced = false;
  std::vector<double> energy(n, 0.0);
  result.stop_reason = "time_limit";
  while (t < options.simulated_time_limit) {
    const Clock::time_point begun = Clock::now();
    const double h = time_step.h();
    std::vector<Contact> contacts = touching.detect(state.x);
    result.times.collisions += seconds_since(begun);
    for (const HeldVertex& held : held_points) kinematic.target[held.vertex] = position_at(held, t + h);

    const Positions before = state.x;
    const StepOutcome outcome = solver.step(state, h, relaxation_factor(t, options), contacts, kinematic, step_times);
    result.newton_iterations += outcome.newton_iterations;
    result.cg_iterations += outcome.cg_iterations;
    if (outcome.accepted && finite(state.x)) {
      const long limited = touching.limit(before, state.x);
      if (limited > 0)
        for (std::size_t v = 0; v < n; ++v) state.v[v] = (state.x[v] - before[v]) / h;
      result.limited_vertices += limited;
      touching.remember(contacts, state.x);
      if (relaxing(t, options)) std::fill(state.v.begin(), state.v.end(), Vec3::Zero());
      t += h;
      ++result.steps;
      time_step.accepted();
      energy = solver.kinetic_energy(state);
      bool quiet = rest.update(energy, h);
      if (quiet && t >= moving_until && options.rest_residual > 0) {
        // The check costs about half a step, so it is not made at each one.
        if (t >= next_force_check) {
          balanced = rms_residual(solver.static_forces(state.x, contacts), solver.masses(), kinematic.held) <
                     options.rest_residual;
          next_force_check = t + kForceCheckInterval;
        }
        quiet = balanced;
      }
      if (t < moving_until) rest.reset();
      // Without early stop the run goes on, and says what it ended in.
      result.stop_reason = quiet && t >= moving_until ? "at_rest" : "time_limit";
      if (options.early_stop && result.stop_reason == "at_rest") break;
    } else {
      state.x = before;
      time_step.rejected();
      if (time_step.too_small()) {
        result.stop_reason = "step_too_small";
        break;
      }
    }
    double kinetic = 0;
    for (double e : energy) kinetic += e;
    if (!progress({t, kinetic, rest.percentile(), h, static_cast<long>(contacts.size()), &state.x})) throw Cancelled{};
  }

  result.time = t;
  result.splits = time_step.splits();
  result.times.derivatives = step_times.derivatives;
  result.times.assembly = step_times.assembly;
  result.times.linear_solve = step_times.linear_solve;
  result.times.line_search = step_times.line_search;
  for (double e : energy) result.kinetic_energy += e;
  result.contacts = touching.detect(state.x);
  result.net_force = solver.static_forces(state.x, result.contacts);
  result.contact_force = solver.contact_forces(state.x, result.contacts);
  result.mass = solver.masses();
  result.net_force.resize(vertices);
  result.contact_force.resize(vertices);
  result.mass.resize(vertices);
  state.x.resize(vertices);
  cloth.x = std::move(state.x);
  return result;
}

}  // namespace toile
