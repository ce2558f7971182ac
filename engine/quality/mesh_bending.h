#pragma once
// What a mesh's pattern of triangles does to the bending stiffness.

#include "engine/mesh/cloth.h"

namespace toile {

/// Stiffness of large-scale bending over the fabric's, the least and the largest over the directions; 1 where the mesh
/// is too small to tell.
struct MeshBending {
  double least = 1, largest = 1;
};

/// Measures the middle of a panel (up to 1500 triangles) with an isotropic fabric: its outer vertices are put on
/// quadratic surfaces, the inner ones relax, and what is left of the energy is the stiffness D_eff(φ) of the cylinders.
/// On vertices that lie on the surface the energy is right for any mesh (terms/bending.h), so what is lost is what the
/// mesh gains by leaving it: little on near-equilateral meshes and on grids with one diagonal (under 1 %), 5 to 7 %
/// where four triangles make a square (terms/bending_balance.h says why).
MeshBending measure_mesh_bending(const Cloth& cloth, int panel);

/// Adds a warning (`mesh_bending: …`) for each panel of these garments that bends 2 % off in some direction.
void warn_of_mesh_bending(Cloth& cloth, const std::vector<char>& garments);

}  // namespace toile
