#pragma once
// What makes the stencils of bending pass the patch test: surfaces of constant curvature are in equilibrium.

#include "engine/terms/curvature_fit.h"

#include <span>

namespace toile {

/// A bending stencil as it lies flat, all of it to first order: heights w [m] over the flat pattern, towards the right
/// side, give the angles θ = `angles` · w, which on a surface of curvature κ are θ = `rows` · κ.
struct FlatBending {
  std::array<int, 6> nodes;            ///< corners and tips, as in BendingStencil
  std::array<bool, 3> hinge{};         ///< opposite to corner i
  std::array<bool, 3> clamped{};       ///< the hinge is a clamp's: its edge and tip are held
  std::array<Vec2, 3> along;           ///< unit vectors along the edges
  Eigen::Matrix<double, 3, 6> angles;  ///< [1/m]
  Mat3 rows, stiffness, factor;        ///< B [m], D [N·m], F [√(N·m)]
  double area;                         ///< [m²]
  int panel;                           ///< with one fabric and one pattern's plane
  bool plain;                          ///< its hinges join two triangles each and are as stiff as cloth
};

/// The fit makes the energy of a triangle right on vertices of a surface of constant curvature, but not its forces: on
/// an irregular mesh they do not cancel, vertices leave the surface, and the mesh bends softer than its fabric: around
/// irregular vertices, along every edge of a panel, where it costs an order of convergence, and by 24 % where four
/// triangles make a square. So each stencil's quadratic form K = Fᵀ F is replaced by Fᵀ (1 + X) F with the symmetric X
/// that minimise
///   Σ_triangles |X|² + w Σ_vertices (|f|² + |e|²),   w = 1000,
/// where f are the forces on a vertex (over the root of its stiffness, and the edge length) and e is by how much the
/// energy of the triangles around it differs from ½ area κᵀ D κ (over the area), both for the curvatures with κᵀ D κ =
/// 1. With both zero the element passes the patch test (Irons & Razzaque 1972; Strang & Fix 1973, §4.2). Within reach
/// of a free edge only the curvature without moment across that edge counts. Corners of free edges, and what is in
/// reach of another panel, of an edge with its own stiffness or of a clamp's far side, stay as they are. In an
/// equilateral mesh X = 0; the panel mesher's meshes have it along their rims, with 1 + X from 0.4 to 1.8. Not every
/// mesh admits both: where four triangles make a square, by symmetry one entry of X is free (between the hinge on the
/// square's edge and the two others), and the value at which the forces cancel leaves 1 + X singular: the middles of
/// all squares could rise over their corners for nothing. No quadratic form of six nodes does better there. So X is
/// scaled down where it must be to keep 1 + X within [0.3, 3], and such a grid bends with 93 to 95 %. Returns S = √(1 +
/// X) per stencil: K = (S F)ᵀ (S F).
std::vector<Mat3> balanced(std::span<const FlatBending> stencils, std::size_t vertices);

}  // namespace toile
