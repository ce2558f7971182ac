#pragma once
// The pear loop of Peirce (1930), for cloth too limp for a cantilever: a strip hangs from its two ends, held face to
// face with the strip leaving straight down.

#include "engine/drape.h"
#include "engine/scene/experiment.h"

namespace toile {

struct PearLoopResult {
  PearLoopReport report;
  Drape drape;
};

/// The ends' middle surfaces are as far apart as the cloth is thick. The start is a loop of the strip's true length
/// made of two arcs a side. Warns (`stiff_loop`) of a height that is the weightless loop's: it does not tell the
/// stiffness. Not converged where over a hundredth of the strip is compressed beyond the membrane's model. Throws what
/// drape() throws.
PearLoopResult hang_loop(const PearLoop& experiment, int threads, Monitor& monitor);

}  // namespace toile
