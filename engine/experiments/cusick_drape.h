#pragma once
// The drape test of Cusick (1968; BS 5058, ISO 9073-9): how much of a round specimen's shadow is left when it hangs
// over a smaller support.

#include "engine/drape.h"
#include "engine/scene/experiment.h"

namespace toile {

struct CusickResult {
  CusickReport report;
  Drape drape;  ///< the hanging of least energy; body_mesh is the support's plates
};

/// The mesh of the ring that hangs: the part between the plates is held flat, and its rim is a clamp. A start is flat
/// but for waves that grow towards the rim, up to a twentieth of the overhang high: all of 2 to 10 a turn, with phases
/// of its own, because equilibria with several counts of folds exist, and no specimen is as flat as another. Under it
/// is a platform, lowered in lowering_time: its share of the weight falls linearly to none, by
/// SolverOptions::weight_ramp_time. So it hangs by drape(). Throws what drape() throws. If no start comes to rest,
/// drape.report.status is "not_converged". Warns of `unusual_nodes`: counts that real cloth does not show.
CusickResult hang(const CusickDrape& experiment, int threads, Monitor& monitor);

}  // namespace toile
