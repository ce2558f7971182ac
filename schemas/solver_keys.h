#pragma once
// The keys of the scene's `solver` object and the members of SolverOptions that they set.

#include "engine/scene/solver_options.h"

namespace toile {

/// Calls visit(key, member, unit) for every option; SI value = JSON value · unit (integers and switches: unit 1).
template <typename Options, typename Visit>
void for_each_solver_key(Options& o, Visit visit) {
  visit("max_time_step_s", o.max_time_step, 1.0);
  visit("simulated_time_limit_s", o.simulated_time_limit, 1.0);
  visit("newton_tolerance_kg_m_s", o.newton_tolerance, 1.0);
  visit("newton_momentum_fraction", o.newton_momentum_fraction, 1.0);
  visit("cg_tolerance", o.cg_tolerance, 1.0);
  visit("newton_iterations", o.newton_iterations, 1.0);
  visit("line_search_iterations", o.line_search_iterations, 1.0);
  visit("cg_iterations", o.cg_iterations, 1.0);
  visit("splitting_factor", o.splitting_factor, 1.0);
  visit("steps_before_growth", o.steps_before_growth, 1.0);
  visit("air_drag_per_s", o.air_drag, 1.0);
  visit("relaxation_time_s", o.relaxation_time, 1.0);
  visit("relaxation_stiffness", o.relaxation_stiffness, 1.0);
  visit("relaxation_step_divisor", o.relaxation_step_divisor, 1.0);
  visit("weight_ramp_s", o.weight_ramp_time, 1.0);
  visit("contact_stiffness_N_m", o.contact_stiffness, 1.0);
  visit("contact_distance_mm", o.contact_distance, 1e-3);
  visit("body_offset_mm", o.body_offset, 1e-3);
  visit("rest_kinetic_energy_j", o.rest_kinetic_energy, 1.0);
  visit("rest_window_s", o.rest_window, 1.0);
  visit("rest_residual", o.rest_residual, 1.0);
  visit("early_stop", o.early_stop, 1.0);
  visit("gravity", o.gravity, 1.0);
  visit("threads", o.threads, 1.0);
}

}  // namespace toile
