#include "engine/drape.h"

#include "engine/check.h"
#include "engine/mesh/build_cloth.h"
#include "engine/parallel/thread_limit.h"
#include "engine/plausible_size.h"
#include "engine/quality/measure.h"
#include "engine/quality/mesh_bending.h"
#include "engine/quality/stretch.h"
#include "engine/quality/warnings.h"
#include "engine/scene/check.h"
#include "engine/scene/problem.h"
#include "engine/solve/assemble.h"
#include "engine/solve/place_trims.h"
#include "engine/solve/preview.h"
#include "engine/solve/simulate.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace toile {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Shares of a run's expected time, for the estimate of what is done.
constexpr double kAssembled = 0.15, kDraped = 0.97;

/// Passes progress on a few times a second, never falling.
class Reporter {
 public:
  explicit Reporter(Monitor& monitor) : monitor_(monitor) {}

  bool operator()(Progress progress) {
    fraction_ = std::clamp(progress.fraction_done, fraction_, 1.0);
    progress.fraction_done = fraction_;
    return monitor_.report(progress);
  }

 private:
  Monitor& monitor_;
  double fraction_ = 0;
};

/// The reference rung: tolerances a hundred to a thousand times tighter, and no early stop.
SolverOptions options_of(const Scene& scene) {
  SolverOptions options = scene.solver;
  if (scene.fidelity != Fidelity::reference) return options;
  options.newton_tolerance = std::min(options.newton_tolerance, 1e-6);
  options.newton_momentum_fraction = std::min(options.newton_momentum_fraction, 1e-3);
  options.cg_tolerance = std::min(options.cg_tolerance, 1e-4);
  options.newton_iterations = std::max(options.newton_iterations, 10);
  options.early_stop = false;
  return options;
}

struct Bodies {
  std::optional<BodyField> whole, without_overhangs, for_legs;
  BodyFields fields() const {
    const auto given = [](const std::optional<BodyField>& field) { return field ? &*field : nullptr; };
    return {given(whole), given(without_overhangs), given(for_legs)};
  }
};

Bodies make_bodies(const Scene& scene, const Cloth& cloth) {
  Bodies bodies;
  if (!scene.body) return bodies;
  bodies.whole = make_body_field(*scene.body, smallest_edge_length(cloth));
  if (!cloth.seam_pairs.empty()) {
    bodies.without_overhangs = bodies.whole->without_overhangs();
    bodies.for_legs = bodies.without_overhangs->with_pointed_toes();
  }
  return bodies;
}

bool slides_on_body(const Scene& scene) {
  return std::any_of(scene.garments.begin(), scene.garments.end(), [](const Garment& garment) {
    return std::any_of(garment.pins.begin(), garment.pins.end(), [](const Pin& pin) {
      const auto* attached = std::get_if<PinAttached>(&pin.hold);
      return attached && attached->slides;
    });
  });
}

bool has_trims(const Scene& scene) {
  return std::any_of(scene.garments.begin(), scene.garments.end(), [](const Garment& g) {
    return !g.elastics.empty() || !g.drawcords.empty() || !g.trims.empty() || !g.zippers.empty();
  });
}

void fill_simulation(const Simulation& simulation, const std::vector<HeldVertex>& held, double contact_stiffness,
                     Drape& drape) {
  Report& report = drape.report;
  report.stop_reason = simulation.stop_reason;
  report.status = simulation.stop_reason == "at_rest" ? "converged" : "not_converged";
  report.simulated_time = simulation.time;
  report.steps = simulation.steps;
  report.newton_iterations = simulation.newton_iterations;
  report.cg_iterations = simulation.cg_iterations;
  report.splits = simulation.splits;
  report.limited_vertices = simulation.limited_vertices;
  report.kinetic_energy = simulation.kinetic_energy;
  const StageTimes before = report.time;
  report.time = simulation.times;
  report.time.assemble = before.assemble;
  std::vector<char> is_held(drape.cloth.x.size(), 0);
  for (const HeldVertex& h : held) is_held[h.vertex] = 1;
  measure_residual(simulation.net_force, simulation.mass, is_held, report);
  report.energies = simulation.energies;
  measure_contacts(drape.cloth, simulation.contacts, simulation.cloth_contacts, contact_stiffness, Friction::known,
                   report);
  drape.contact_force = simulation.contact_force;
}

}  // namespace

Drape drape(const Scene& scene, Monitor& monitor) {
  const Clock::time_point started = Clock::now();
  Reporter reporter(monitor);
  const auto stage = [&](std::string_view name, double fraction) {
    if (!reporter({name, 0, 0, 0, fraction})) throw Cancelled{};
  };
  const ThreadLimit threads(scene.solver.threads);
  check_scene(scene);
  stage("mesh", 0);
  Cloth apart = build_cloth(scene);
  check_flat_size(apart, given_as_mesh(scene));
  warn_of_mesh_bending(apart, given_as_mesh(scene));
  check_something_is_left(apart);
  stage("body", 0.01);
  const Bodies bodies = make_bodies(scene, apart);
  if (bodies.whole) check_size(apart, *bodies.whole);

  stage("assemble", 0.02);
  const std::vector<std::string> found = apart.warnings;
  Assembly assembly;
  try {
    assembly = assemble(scene, std::move(apart), bodies.fields(), [&](const AssemblyState& state) {
      return reporter({"assemble", 0, 0, state.contacts, 0.02 + (kAssembled - 0.02) * state.fraction});
    });
  } catch (const InputError& error) {
    rethrow_with_sizes(error, found);
  }
  Drape result;
  result.cloth = std::move(assembly.cloth);
  Report& report = result.report;
  report.time.assemble = seconds_since(started);
  report.seam_gap_max = assembly.seam_gap_max;
  report.warnings = result.cloth.warnings;
  if (bodies.whole)
    for (const std::string& warning : bodies.whole->warnings()) report.warnings.push_back(warning);

  result.contact_force.assign(result.cloth.x.size(), 0.0);
  std::vector<double> contact_distance;
  if (!assembly.open_seams.empty()) {
    report.status = "failed";
    report.stop_reason = "seams_open";
    for (const std::string& seam : assembly.open_seams) report.warnings.push_back("seam did not close: " + seam);
  } else if (scene.fidelity == Fidelity::preview) {
    const std::vector<HeldVertex> held = held_vertices(scene, result.cloth, assembly.attached);
    const Positions start = result.cloth.x;
    const PreviewOutcome outcome =
        settle_preview(scene, result.cloth, bodies.fields().whole, held, [&](double fraction, long contacts) {
          return reporter({"drape", 0, 0, contacts, kAssembled + (kDraped - kAssembled) * fraction});
        });
    report.steps = outcome.steps;
    report.stop_reason = outcome.at_rest ? "at_rest" : "time_limit";
    report.status = outcome.at_rest ? "converged" : "not_converged";
    report.time.drape = seconds_since(started) - report.time.assemble;
    contact_distance = measure_equilibrium(result.cloth, start,
                                           {options_of(scene),
                                            bodies.fields().whole,
                                            scene.body ? scene.body->friction.value_or(-1) : 0.0,
                                            held,
                                            scene.friction_pairs,
                                            {},
                                            {}},
                                           {.bending_friction = false}, report);
    report.warnings.push_back("preview: positions only, no forces; not an equilibrium of the fabric");
    if (slides_on_body(scene)) report.warnings.push_back("preview: what slides along the body is held");
    if (has_trims(scene))
      report.warnings.push_back("preview: elastics, drawcords and tapes do not pull, trims are left out");
  } else {
    const std::vector<SlidingVertex> sliding = sliding_vertices(scene, result.cloth);
    SimulationScene simulated{options_of(scene),
                              bodies.fields().whole,
                              scene.body ? scene.body->friction.value_or(-1) : 0.0,
                              held_vertices(scene, result.cloth, assembly.attached, sliding),
                              scene.friction_pairs,
                              sliding,
                              make_trimmings(scene, result.cloth)};
    const Simulation simulation = simulate(result.cloth, simulated, [&](const SimulationState& state) {
      const bool relaxing = state.time < scene.solver.relaxation_time;
      return reporter({relaxing ? "relax" : "drape", state.time, state.kinetic_energy, state.contacts,
                       kAssembled + (kDraped - kAssembled) * estimated_progress(state, scene.solver)});
    });
    fill_simulation(simulation, simulated.held, simulated.options.contact_stiffness, result);
    result.trims = simulated.trimmings.trims;
    for (std::size_t t = 0; t < result.trims.size(); ++t) result.trims[t].start = simulation.trims[t];
    contact_distance = simulation.contact_distance;
    report.time.drape = seconds_since(started) - report.time.assemble;
  }
  stage("measure", kDraped);
  measure_geometry(result.cloth, bodies.fields().whole, report);
  add_warnings(result.cloth, contact_distance, scene.solver, report);
  if (bodies.whole)
    warn_of_far_garments(result.cloth, *bodies.whole, assembly.attached, near_body(scene, result.cloth), report);
  if (report.status == "converged" && report.penetration_max > kWrongSide) {
    report.status = "not_converged";
    report.stop_reason = "inside_body";
  }
  const TriangleStretch stretch = triangle_stretch(result.cloth.flat, result.cloth.triangles, result.cloth.x);
  result.stretch_warp = stretch.warp;
  result.stretch_weft = stretch.weft;
  if (bodies.whole) result.body_mesh = bodies.whole->surface();
  append_trims(result.trims, result.body_mesh);
  report.time.total = seconds_since(started);
  return result;
}

}  // namespace toile
