#pragma once
// What any drape is worth, however it came about: the same numbers for a mesh of ours and of another program.

#include "engine/mesh/cloth.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/report.h"
#include "engine/scene/scene.h"
#include "engine/solve/simulate.h"

#include <vector>

namespace toile {

struct CheckOptions {
  /// Cloth that is so near to the body or to cloth counts as touching [m]; 0: as near as the scene's own contact
  /// reaches. For programs that keep layers farther apart than this one does. Between cloth and cloth, 0.3 of the
  /// smallest altitude of the triangles around bounds it, as everywhere.
  double touch = 0;
  /// Whether the friction of bending may do what it likes within its law; without it, there is none.
  bool bending_friction = true;
};

/// Judges `mesh` as a drape of the scene's garments, at rest: stretch, penetration, intersections, seam gaps, energies,
/// contacts, the discretisation error, warnings, and the residual of the forces. Of contacts only their places are
/// taken from the mesh: they may press and rub with any force in their Coulomb cones, and the residual is what the best
/// choice leaves (quality/admissible_contact.h). So it is no larger than that of a drape's own report, up to the end of
/// that search, and knows nothing of the history of friction. Nor of that of bending: where a fabric rubs as it bends,
/// each triangle may have any moment that its friction allows (quality/admissible_forces.h). Rigid trims, which the
/// mesh does not show, lie where they are at rest on it without friction (solve/still_cloth.h); if they have any, a
/// warning says so. Vertices that the scene's pins hold, as they select them at the start, may be anywhere; clamps hold
/// the planes in which the panels lie before they are sewn. How `mesh` is matched to the garments is said in
/// mesh/match_mesh.h. report.stop_reason is "checked", and status "converged" if the residual's rms is under
/// solver.rest_residual (0.05 where that is 0), no seam gapes by 1 mm and no cloth is 10 mm inside the body. Throws
/// InputError: the scene's problems, and `mesh_mismatch` at "".
Report judge(const Scene& scene, const TriangleMesh& mesh, const CheckOptions& options = {});

/// Its part about forces, of a sewn cloth at its positions, which was at `start` as the drape began
/// (solve/still_cloth.h): energies, contacts, discretisation error, residual. Returns where cloth repels cloth, per
/// vertex [m].
std::vector<double> measure_equilibrium(const Cloth& sewn, const Positions& start, const SimulationScene& scene,
                                        const CheckOptions& options, Report& report);

}  // namespace toile
