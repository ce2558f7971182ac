#pragma once
// Second half of a drape: Algorithm 1 of the first seed, from the sewn garment to rest.

#include "engine/contact/contact.h"
#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"
#include "engine/scene/friction.h"
#include "engine/scene/solver_options.h"
#include "engine/solve/pin_motion.h"
#include "engine/solve/touching.h"
#include "engine/solve/trimmings.h"
#include "engine/terms/trim_contact.h"

#include <functional>
#include <string>
#include <vector>

namespace toile {

struct SimulationState {
  double time = 0;              ///< simulated [s]
  double kinetic_energy = 0;    ///< [J]
  double nodal_energy_p99 = 0;  ///< [J]
  double step = 0;              ///< h [s]
  long contacts = 0;
  const Positions* x = nullptr;  ///< of the cloth's vertices, and of clamps' points behind them
};
/// A guess at the share done, 0 to 1: most drapes are at rest after one to three simulated seconds, so time counts as
/// t/(t + 1 s); it is 1 at the limit.
double estimated_progress(const SimulationState& state, const SolverOptions& options);

/// Called once per step; false cancels (throws Cancelled).
using SimulationProgress = std::function<bool(const SimulationState&)>;

struct Simulation {
  std::string stop_reason;  ///< "at_rest", "time_limit", "step_too_small"
  double time = 0;          ///< simulated [s]
  long steps = 0, newton_iterations = 0, cg_iterations = 0, splits = 0;
  long limited_vertices = 0;       ///< vertex moves cut short, summed over steps, because they could have crossed cloth
  StageTimes times;                ///< the parts of `drape`
  double kinetic_energy = 0;       ///< [J] at the end
  std::vector<Contact> contacts;   ///< at the end, friction included; those of the cloth with itself first, …
  std::size_t cloth_contacts = 0;  ///< … so many of them
  std::vector<double> contact_distance;         ///< per vertex, where cloth repels cloth [m]
  std::vector<TermEnergy> energies;             ///< of what is not contact, at the end
  Positions net_force;                          ///< contacts and friction included; on held ones, what holds bears [N]
  std::vector<double> mass;                     ///< lumped [kg]
  std::vector<RigidState> trims;                ///< at the end
  std::vector<double> contact_force;            ///< per vertex, sum of contact force magnitudes [N]
  std::vector<TrimContact> trim_contacts = {};  ///< at the end, friction included
};

struct SimulationScene {
  SolverOptions options;
  const BodyField* body = nullptr;
  double body_friction = 0;  ///< < 0: each fabric's own
  std::vector<HeldVertex> held;
  std::vector<FrictionPair> friction_pairs;  ///< contact/friction_table.h
  std::vector<SlidingVertex> sliding;        ///< along the body; empty without one
  Trimmings trimmings;
};

TouchingOptions touching_options(const SimulationScene& scene);

/// Advances cloth.x to rest. No NaN is ever written to it: a step that fails at the smallest time step ends the run
/// with "step_too_small". Deterministic on any number of threads.
Simulation simulate(Cloth& cloth, const SimulationScene& scene, const SimulationProgress& progress);

}  // namespace toile
