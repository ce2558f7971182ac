#pragma once
// The engine's one entry: a scene in, the garment's equilibrium drape and what it is worth out.

#include "engine/mesh/cloth.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/monitor.h"
#include "engine/report.h"
#include "engine/scene/scene.h"
#include "engine/solve/trimmings.h"

#include <memory>

namespace toile {

struct Drape {
  Cloth cloth;  ///< sewn and draped: final positions in cloth.x
  /// The body as a surface (a plane: a large square) and the trims, for pictures; empty without either.
  TriangleMesh body_mesh;
  std::vector<RigidTrim> trims;  ///< where they ended, in the order of the garments and their trims,
                                 ///< then those of their zippers
  /// Per vertex of cloth, sum of contact forces [N] (overlay `contact`).
  std::vector<double> contact_force;
  /// Per triangle, stretch ratio minus one along warp and weft (overlay `stretch`).
  std::vector<double> stretch_warp, stretch_weft;
  Report report;
};

/// Assembles (panels meshed, pushed out of the body, sewn) and drapes (backward-Euler Newton to rest).
/// Throws InputError for input that can't be simulated and Cancelled when the monitor says so. A drape that did not
/// reach rest, whose seams did not close, or that is over 10 mm inside the body, returns with report.status saying so;
/// no NaN is ever returned.
/// Deterministic: the same scene gives the same bytes on any number of threads. Not to be called twice at once with
/// different solver.threads (the limit on threads is process-wide).
Drape drape(const Scene& scene, Monitor& monitor);

}  // namespace toile
