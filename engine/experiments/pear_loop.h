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
/// made of two arcs a side. Throws what drape() throws.
PearLoopResult hang_loop(const PearLoop& experiment, int threads, Monitor& monitor);

}  // namespace toile
