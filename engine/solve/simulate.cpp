#include "engine/solve/simulate.h"

#include "engine/monitor.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/clamps.h"
#include "engine/solve/relaxation.h"
#include "engine/solve/rest.h"
#include "engine/solve/time_step.h"
#include "engine/solve/touching.h"
#include "engine/solve/trim_touching.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace toile {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kForceCheckInterval = 0.01;  // [s]

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Of the net force over nodal weight, on free vertices.
double rms_residual(const Positions& force, const std::vector<double>& mass, const std::vector<char>& held) {
  double sum = 0;
  long count = 0;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (held[v] || mass[v] <= 0) continue;
    sum += force[v].squaredNorm() / std::pow(mass[v] * kGravity, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

bool finite(const Positions& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); });
}

bool finite(const std::vector<RigidState>& trims) {
  return std::all_of(trims.begin(), trims.end(), [](const RigidState& t) {
    return t.center.allFinite() && t.orientation.coeffs().allFinite() && t.velocity.allFinite() &&
           t.angular_velocity.allFinite();
  });
}

void stop(State& state) {
  std::fill(state.v.begin(), state.v.end(), Vec3::Zero());
  for (RigidState& trim : state.trims) trim.velocity = trim.angular_velocity = Vec3::Zero();
}

}  // namespace

double estimated_progress(const SimulationState& state, const SolverOptions& options) {
  return std::max(state.time / (state.time + 1.0 + options.weight_ramp_time),
                  state.time / options.simulated_time_limit);
}

TouchingOptions touching_options(const SimulationScene& scene) {
  return {scene.body,           scene.body_friction, scene.options.contact_distance, scene.options.body_offset,
          scene.friction_pairs, scene.sliding};
}

Simulation simulate(Cloth& cloth, const SimulationScene& scene, const SimulationProgress& progress) {
  const SolverOptions& options = scene.options;
  Simulation result;
  Touching touching(cloth, touching_options(scene));
  TrimTouching trim_touching(cloth, scene.trimmings.trims, touching_options(scene));
  Cloth clamped = cloth;
  std::vector<HeldVertex> held_points = scene.held;
  const std::vector<HeldVertex> clamp_points = add_clamps(clamped, scene.held);
  held_points.insert(held_points.end(), clamp_points.begin(), clamp_points.end());
  BackwardEuler solver(clamped, options, scene.trimmings);
  const std::size_t vertices = cloth.x.size(), n = clamped.x.size();
  TimeStep time_step(options);
  RestDetector rest(options);
  DampingRelief relief(options);
  StepTimes step_times;
  State state{clamped.x, Positions(n, Vec3::Zero()), {}};
  for (const RigidTrim& trim : scene.trimmings.trims) state.trims.push_back(trim.start);
  Kinematic kinematic{std::vector<char>(n, 0), clamped.x};
  for (const HeldVertex& held : held_points) kinematic.held[held.vertex] = 1;
  const double moving_until = std::max({last_key_frame(scene.held), options.relaxation_time, options.weight_ramp_time});

  std::vector<Contact> contacts;
  std::vector<TrimContact> trim_contacts;
  const auto detect = [&] {
    const Clock::time_point begun = Clock::now();
    contacts = touching.detect(state.x);
    trim_contacts = trim_touching.detect(state.x, state.trims);
    result.times.collisions += seconds_since(begun);
  };

  const Clock::time_point began = Clock::now();
  double t = 0, next_force_check = 0;
  bool balanced = false;
  std::vector<double> energy(vertices, 0.0);
  result.stop_reason = "time_limit";
  detect();
  while (t < options.simulated_time_limit) {
    const double h = time_step.h();
    for (const HeldVertex& held : held_points) kinematic.target[held.vertex] = position_at(held, t + h);

    const Positions v_before = state.v;
    const Positions before = state.x;
    const std::vector<RigidState> trims_before = state.trims;
    // As it is at the step's end, like the held vertices' targets.
    solver.set_weight(weight_share(t + h, options));
    const StepOutcome outcome =
        solver.step(state, h, relaxation_factor(t, options), contacts, kinematic, step_times, &trim_contacts);
    result.newton_iterations += outcome.newton_iterations;
    result.cg_iterations += outcome.cg_iterations;
    if (outcome.accepted && finite(state.x) && finite(state.trims)) {
      const long limited = touching.limit(before, state.x);
      if (limited > 0)
        for (std::size_t v = 0; v < n; ++v) state.v[v] = (state.x[v] - before[v]) / h;
      result.limited_vertices += limited;
      touching.remember(contacts, state.x);
      trim_touching.remember(trim_contacts, state.x, state.trims);
      if (relaxing(t, options)) stop(state);
      detect();
      t += h;
      ++result.steps;
      time_step.accepted();
      energy = solver.kinetic_energy(state);
      const auto first_clamp = energy.begin() + static_cast<std::ptrdiff_t>(vertices);
      energy.erase(first_clamp, first_clamp + static_cast<std::ptrdiff_t>(n - vertices));
      bool quiet = rest.update(energy, h);
      // A trim is one node among thousands, but its swing is not noise: each has to be at rest.
      if (std::any_of(energy.begin() + static_cast<std::ptrdiff_t>(vertices), energy.end(),
                      [&](double e) { return e >= options.rest_kinetic_energy; })) {
        rest.reset();
        quiet = false;
      }
      if (quiet && t >= moving_until && options.rest_residual > 0) {
        // The check costs about half a step, so it is not made at each one. It is that of the result: with the contacts
        // as they are found where the step led, not those that it was made with.
        if (t >= next_force_check) {
          balanced = rms_residual(solver.static_forces(state.x, contacts, state.trims, trim_contacts), solver.masses(),
                                  kinematic.held) < options.rest_residual;
          next_force_check = t + kForceCheckInterval;
        }
        solver.set_damping(relief.update(true, balanced, h));
        quiet = balanced;
      } else {
        solver.set_damping(relief.update(false, false, h));
      }
      if (t < moving_until) rest.reset();
      // Without early stop the run goes on, and says what it ended in.
      result.stop_reason = quiet && t >= moving_until ? "at_rest" : "time_limit";
      if (options.early_stop && result.stop_reason == "at_rest") break;
    } else {
      state.x = before;
      state.v = v_before;
      state.trims = trims_before;
      detect();
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
  result.times.other = std::max(0.0, seconds_since(began) - result.times.collisions - step_times.derivatives -
                                         step_times.assembly - step_times.linear_solve - step_times.line_search);
  for (double e : energy) result.kinetic_energy += e;
  result.contacts = std::move(contacts);
  result.trim_contacts = std::move(trim_contacts);
  result.net_force = solver.static_forces(state.x, result.contacts, state.trims, result.trim_contacts);
  result.trims = state.trims;
  result.contact_force = solver.contact_forces(state.x, result.contacts, state.trims, result.trim_contacts);
  result.mass = solver.masses();
  result.energies = solver.energies_by_term(state.x, state.trims, result.trim_contacts);
  result.cloth_contacts = touching.cloth_contacts();
  result.contact_distance = touching.contact_distance();
  result.net_force.resize(vertices);
  result.contact_force.resize(vertices);
  result.mass.resize(vertices);
  state.x.resize(vertices);
  cloth.x = std::move(state.x);
  return result;
}

}  // namespace toile
