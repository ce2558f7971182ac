#pragma once
// Time splitting (the first seed's §3.1.3).

#include "engine/scene/solver_options.h"

namespace toile {

/// The length of the next step: h ← ω h after a failed step, h ← h/ω after every `steps_before_growth` successes in a
/// row, never above max_time_step. With an initial relaxation h starts at max_time_step / relaxation_step_divisor
/// (§5.2).
class TimeStep {
 public:
  explicit TimeStep(const SolverOptions& options);
  double h() const { return h_; }  ///< [s]
  long splits() const { return splits_; }
  void accepted();
  void rejected();
  /// The state can't be advanced: h fell below a 100,000th of max_time_step (40 splits in a row at ω = 0.75).
  bool too_small() const { return h_ < 1e-5 * max_; }

 private:
  double h_, max_, factor_;
  int successes_ = 0, needed_;
  long splits_ = 0;
};

}  // namespace toile
