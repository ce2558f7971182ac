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

/// The mesh of the ring that hangs: the part between the plates is held flat, and its rim is a clamp. Start k is flat
/// but for waves that grow towards the rim, where they are a twentieth of the overhang high: the first has many, the
/// others 4, 5, 6, 7, 8, 4, … in turn, because equilibria with several counts exist and a cloth may come to rest in any
/// of them. Let go, it hangs by drape(). Throws what drape() throws. If no start comes to rest, drape.report.status is
/// "not_converged".
CusickResult hang(const CusickDrape& experiment, int threads, Monitor& monitor);

}  // namespace toile
