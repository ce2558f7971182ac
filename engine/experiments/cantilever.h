#pragma once
// The cantilever test of Peirce (1930; ASTM D1388 option A, ISO 9073-7): a strip pushed over an edge bends down.

#include "engine/drape.h"
#include "engine/scene/experiment.h"

namespace toile {

struct CantileverResult {
  CantileverReport report;
  Drape drape;
};

/// Holds the strip flat up to the edge, a clamp, and lets all of the overhang go at once. Without an overhang given, it
/// is found by the secant rule over its logarithm, to 0.05°. Throws what drape() throws; drape.report.status says
/// "not_converged" where the strip did not come to rest or no overhang from 2 mm to 1 m falls so far.
CantileverResult bend_over(const Cantilever& experiment, int threads, Monitor& monitor);

}  // namespace toile
