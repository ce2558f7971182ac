#pragma once
// Initial relaxation (the first seed's §5.2): a badly stretched start gives up its energy slowly.

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

}  // namespace toile
