#pragma once
// The strip tensile test (ISO 13934-1 and, at small strains, KES-FB1) and, cut on the bias, the bias-extension test.

#include "engine/drape.h"
#include "engine/scene/experiment.h"

namespace toile {

struct UniaxialResult {
  UniaxialReport report;
  Drape drape;  ///< at the last strain
};

/// Of the solver for a strip in its plane, to an equilibrium as exact as steps in single precision find it: no weight,
/// no air.
SolverOptions pull_options();

/// Grips hold the whole width of both ends, which do not narrow. The strip stays in its plane: it has no weight here
/// and does not wrinkle. Each strain is an equilibrium, found by steps of backward Euler whose velocities are taken
/// away, to a net force of 1e-5 of the pull at every vertex. drape.report.status is "not_converged" where one was not
/// found.
UniaxialResult pull(const UniaxialTest& experiment, int threads, Monitor& monitor);

}  // namespace toile
