#pragma once
// Bending across the edges of the mesh: hinges, with their dissipation.

#include "engine/mesh/cloth.h"
#include "engine/terms/stencil.h"

namespace toile {

/// Elastic energy of a hinge [J] and its stiffness k [N·m/rad]:
///   ½ k (θ − θ₀)²,  k = D l² / (A₀ + A₁)
/// [Grinspun et al. 2003; Tamstorf & Grinspun 2013], θ the dihedral angle (geometry/dihedral.h), l the edge and A the
/// two triangles in the flat pattern (l: the mean where two flats differ). D [N·m] is the textile one: the stiffness
/// per width of cylindrical bending, which this coefficient gives exactly on an equilateral mesh (shared/validation;
/// other published coefficients differ by factors of 3 to 4). Dissipation potential [W]: R = ½ β k θ̇², θ̇ = ∇θ·v [after
/// Sánchez-Banderas & Otaduy 2018]. Velocity derivative: exact. Position derivative of the dissipative force: dropped
/// (it is not symmetric, and of the order of the angle's change in a step relative to what is kept). The angle is that
/// of the points, whatever the winding of the triangles, so the hinge is right where a stitch turns the fabric over
/// (right_wrong).
struct BendingStencil {
  std::array<int, 4>
      nodes;          ///< the edge's ends as the first triangle runs along it, its tip, the second triangle's tip
  double stiffness;   ///< k [N·m]
  double rest_angle;  ///< θ₀ [rad]
  double damping;     ///< β [s]
};

/// D of a hinge whose edge has its normal at `angle` from weft in the flat pattern [N·m]: bending across an edge
/// happens along the edge's normal. The textile's law through its three measured directions is
///   D(φ) = d₀ + d₂ cos 2φ + d₄ cos 4φ
/// (the orthotropic plate's). A lattice of hinges averages its coefficients over the three edge directions with the
/// weight (8/9) cos⁴: the mean passes unchanged, the second harmonic only by ⅔, the fourth by ⅙. So the coefficient is
///   d₀ + 3/2 d₂ cos 2φ + d₄ cos 4φ,
/// which restores the difference between warp and weft (averaged over lattice orientations), and leaves the fourth
/// harmonic, whose correction would alias. At least a tenth of the smallest of the three.
double hinge_bending_stiffness(const Directional& bending, double angle);

/// One stencil for each edge of two triangles. Across a seam or two fabrics: the mean of both sides' D and β.
std::vector<BendingStencil> bending_stencils(const Cloth& cloth);

double bending_energy(const BendingStencil& s, const StencilPoints<4>& x);
StencilVector<4> bending_gradient(const BendingStencil& s, const StencilPoints<4>& x);
StencilMatrix<4> bending_hessian(const BendingStencil& s, const StencilPoints<4>& x);
/// The Gauss–Newton part k ∇θ ∇θᵀ: exact at the rest angle.
StencilMatrix<4> bending_hessian_psd(const BendingStencil& s, const StencilPoints<4>& x);

/// R [W]
double bending_dissipation(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v);
/// ∂R/∂v [N] = minus the dissipative force.
StencilVector<4> bending_dissipation_gradient(const BendingStencil& s, const StencilPoints<4>& x,
                                              const StencilPoints<4>& v);
/// ∂²R/∂v² [N·s/m], positive semi-definite.
StencilMatrix<4> bending_dissipation_hessian(const BendingStencil& s, const StencilPoints<4>& x);

/// Elastic and dissipative force at once. A hinge with a triangle under 1 µm high has no angle to speak of and answers
/// with nothing (here and in bending_response).
std::array<Vec3, 4> bending_force(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v,
                                  double fabric_factor);

/// Force, and the system's share of the hinge as one vector: its blocks are rowᵢ rowⱼᵀ.
struct BendingResponse {
  std::array<Vec3, 4> force;
  std::array<Eigen::Vector3f, 4> row;
};
/// row rowᵀ = stiffness · _hessian_psd + dissipation · _dissipation_hessian.
void bending_response(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v,
                      const SystemWeights& weights, BendingResponse& out);

}  // namespace toile
