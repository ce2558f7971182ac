#include "engine/drape.h"

#include "engine/check.h"
#include "engine/mesh/build_cloth.h"
#include "engine/mesh/sewing.h"
#include "engine/parallel/thread_limit.h"
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
#include <cstdio>
#include <functional>
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

Vec3 extent_of(const Cloth& cloth, const std::function<bool(int)>& counts) {
  Box box;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    if (counts(cloth.triangle_panel[t]))
      for (int v : cloth.triangles[t]) box.extend(cloth.x[v]);
  return box.empty() ? Vec3(Vec3::Zero()) : Vec3(box.upper - box.lower);
}

/// Sewn garments whose size beside the body says that they were drawn in another unit than their document names: one
/// far too long is refused, since sewing it would only take long (throws InputError `implausible_size`); of a tiny one
/// a warning is left in the cloth.
void check_size(Cloth& cloth, const BodyField& body) {
  constexpr double kLongest = 2, kSmallest = 0.12;  // times the body's greatest extent, a panel and a garment
  if (cloth.seam_pairs.empty() || !(body.bounds().upper - body.bounds().lower).allFinite()) return;
  const double height = (body.bounds().upper - body.bounds().lower).maxCoeff();
  char text[240];
  for (std::size_t p = 0; p < cloth.panels.size(); ++p) {
    const double size = extent_of(cloth, [&](int panel) { return panel == static_cast<int>(p); }).maxCoeff();
    if (size <= kLongest * height) continue;
    std::snprintf(text, sizeof text, "panel '%.80s' is %.1f m long and the body %.2f m: are the pattern's units right?",
                  cloth.panels[p].name.c_str(), size, height);
    throw InputError("/garments/" + std::to_string(cloth.panels[p].garment), "implausible_size", text);
  }
  const int garments = cloth.vertex_garment.empty() ? 0 : 1 + cloth.vertex_garment.back();
  for (int g = 0; g < garments; ++g) {
    const double size = extent_of(cloth, [&](int panel) { return cloth.panels[panel].garment == g; }).maxCoeff();
    if (size >= kSmallest * height) continue;
    std::snprintf(text, sizeof text,
                  "implausible_size: garment %d is %.2g m in its longest direction and the body %.2f m: are its units "
                  "right?",
                  g, size, height);
    cloth.warnings.emplace_back(text);
  }
}

/// Throws InputError `empty_garment` where sewing leaves no triangle of a garment: then its edges are too long for it.
void check_something_is_left(const Cloth& apart) {
  if (apart.seam_pairs.empty()) return;
  Cloth sewn = apart;
  merge_seams(sewn);
  const auto has_triangles = [&](const Cloth& cloth, int g) {
    return std::any_of(cloth.triangle_panel.begin(), cloth.triangle_panel.end(),
                       [&](int panel) { return cloth.panels[panel].garment == g; });
  };
  const int garments = apart.vertex_garment.empty() ? 0 : 1 + apart.vertex_garment.back();
  for (int g = 0; g < garments; ++g)
    if (!has_triangles(sewn, g))
      throw InputError(
          "/garments/" + std::to_string(g), "empty_garment",
          "Sewing leaves no triangle of the garment: are its edges too long for its panels, or their units "
          "wrong?");
}

/// What was found odd about sizes explains best why panels can't be sewn.
[[noreturn]] void rethrow_with_sizes(const InputError& error, const std::vector<std::string>& warnings) {
  std::vector<Problem> problems = error.problems();
  for (const std::string& warning : warnings)
    if (warning.rfind("implausible_size: ", 0) == 0)
      problems.push_back({"/garments", "implausible_size", warning.substr(warning.find(' ') + 1)});
  throw InputError(std::move(problems));
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
  add_warnings(result.cloth, contact_distance, scene.solver.contact_distance, report);
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
