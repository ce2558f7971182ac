#pragma once
// Closes the seams of panels that lie clear of the body and of each other.

#include "engine/monitor.h"
#include "engine/solve/assemble.h"
#include "engine/solve/position_based.h"

#include <string>
#include <vector>

namespace toile {

/// Counts the steps of an assembly and tells its progress. step() throws Cancelled.
struct AssemblyStage {
  const Scene& scene;
  const AssemblyProgress& progress;
  long steps = 0;

  double step(PositionBased& solver, Positions& x, const PositionBasedOptions& options, double fraction) {
    const double gap = solver.step(x, options);
    ++steps;
    if (!progress({fraction, gap, solver.largest_move(), solver.contacts(), &x})) throw Cancelled{};
    return gap;
  }
};

/// What a sewing goes by, per vertex and panel of the apart cloth.
struct Sewing {
  const Scene& scene;
  const BodyFields& fields;
  const std::vector<const BodyField*>& field;  ///< that a vertex minds
  const std::vector<char>&keep, &held;         ///< does not sink; does not move
  const std::vector<std::string>& part;        ///< of the body that each panel is for
  double offset;                               ///< from the body [m]
};

struct Sewn {
  Positions x;                          ///< of the apart cloth; seam vertices in one place where seams closed
  std::size_t open = 0, crossings = 0;  ///< seams that did not close; pairs of triangles that cross
  double gap = 0;                       ///< the widest before seam vertices met [m]
};

/// Closes the seams garment by garment, darts and pleats first, then tubes, then what joins them, and draws apart what
/// went through itself on the way. Which speed of closing, inertia and width of the seam zone lead to no tangle can't
/// be foreseen, so several are tried, each from the start; the first sound one is taken, or else the best.
/// Deterministic.
Sewn sew(AssemblyStage& stage, const Sewing& sewing, const Cloth& apart);

/// Names of the seams that are open by more than 1 mm.
std::vector<std::string> open_seams(const Cloth& cloth);

}  // namespace toile
