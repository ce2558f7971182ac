#pragma once
// A drape that comes as a mesh, laid over the garments of a scene.

#include "engine/mesh/cloth.h"
#include "engine/mesh/triangle_mesh.h"

namespace toile {

struct MatchedCloth {
  Cloth cloth;              ///< sewn, at the mesh's positions
  double seam_gap_max = 0;  ///< between vertices that seams make one [m]; 0 for a mesh that is sewn
};

/// Gives the sewn cloth the positions of `mesh`, which is, in the order in which it is tried,
///   the sewn garments: the same vertices in the same order as a run writes them (mesh.obj), triangles in any order;
///   the garments before sewing: the same vertices in the order of the scene's own mesh or panels; those that seams
///   join meet in their mean; the same triangles and corners in the same order, whatever the vertices (a run's
///   mesh.glb, whose body is left out; files that repeat vertices where texture coordinates differ).
/// Texture coordinates, where the mesh has them and it is matched by triangles, must be the flat pattern in any unit.
/// Throws InputError (`mesh_mismatch`) at "" that tells the counts of both, and `mesh_out_of_range` for coordinates
/// beyond a kilometre. A mesh without triangles is matched by its vertices alone.
/// Mind the digits of a file: a nanometre on a triangle of 10 mm is a force of some per cent of a vertex's weight where
/// the fabric is stiff; mesh.obj has all of them, the floats of a GLB have seven.
MatchedCloth match_mesh(const Cloth& apart, const TriangleMesh& mesh);

}  // namespace toile
