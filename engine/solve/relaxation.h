#pragma once
// What begins gently: the initial relaxation (the first seed's §5.2), in which a badly stretched start gives up its
// energy slowly, and the weight.

#include "engine/scene/solver_options.h"

#include <algorithm>

namespace toile {

/// Inside the window velocities are set to zero after each step.
inline bool relaxing(double time, const SolverOptions& options) { return time < options.relaxation_time; }

/// Factor on fabric stiffness at a time: from relaxation_stiffness at 0 linearly to 1 at the window's end, then 1.
inline double relaxation_factor(double time, const SolverOptions& options) {
  if (!relaxing(time, options)) return 1;
  const double done = std::max(0.0, time / options.relaxation_time);
  return options.relaxation_stiffness + (1 - options.relaxation_stiffness) * done;
}

/// Share of the weight that pulls at a time: from 0 linearly to 1 at the end of weight_ramp_time, then 1. What is
/// loaded slowly follows its equilibria and keeps few folds; what is dropped whole throws up the many that grow
/// fastest.
inline double weight_share(double time, const SolverOptions& options) {
  if (!options.gravity) return 0;
  return time < options.weight_ramp_time ? std::max(0.0, time / options.weight_ramp_time) : 1;
}

}  // namespace toile
