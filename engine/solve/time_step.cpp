#include "engine/solve/time_step.h"

#include <algorithm>

namespace toile {

TimeStep::TimeStep(const SolverOptions& options)
    : h_(options.relaxation_time > 0 ? options.max_time_step / options.relaxation_step_divisor : options.max_time_step),
      max_(options.max_time_step),
      factor_(options.splitting_factor),
      needed_(options.steps_before_growth) {}

void TimeStep::accepted() {
  if (++successes_ < needed_) return;
  successes_ = 0;
  h_ = std::min(max_, h_ / factor_);
}

void TimeStep::rejected() {
  successes_ = 0;
  ++splits_;
  h_ *= factor_;
}

}  // namespace toile
