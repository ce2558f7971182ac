#pragma once
// Any experiment, as a job runs it.

#include "engine/drape.h"
#include "engine/scene/experiment.h"

namespace toile {

/// The specimen's final shape, with what was measured in report.experiment. Throws InputError with all of
/// experiment_problems() if there are any, and what the experiment throws.
Drape run_experiment(const Experiment& experiment, int threads, Monitor& monitor);

}  // namespace toile
