#pragma once
// Bending: the curvature of every triangle, fitted to the angles of its hinges, with its dissipation.

#include "engine/mesh/cloth.h"
#include "engine/terms/bending_law.h"
#include "engine/terms/stencil.h"

namespace toile {

/// A triangle and its three neighbours. With θ the dihedral angles (geometry/dihedral.h) of its hinges, θ₀ those of its
/// rest shape and κ = C (θ − θ₀) the curvature of the quadratic surface through its vertices (terms/curvature_fit.h):
///   E = area · ½ κᵀ D κ = ½ (θ − θ₀)ᵀ K (θ − θ₀)   [J],   K = Fᵀ F [N·m/rad]
/// D is the orthotropic plate's tensor with the textile's (cylindrical) D in warp, weft and bias: on vertices of any
/// cylinder the energy is exact in any direction and on any mesh (the quadratic fit of Grinspun, Gingold, Reisman &
/// Zorin 2006, "Computing discrete shape operators on general meshes", written in hinge angles). That alone does not
/// converge on irregular meshes: K and C are then changed a little so that the forces of constant curvature cancel,
/// too, while the energy stays right around each vertex (terms/bending_balance.h). On an equilateral mesh
/// and with Poisson's ratio −1/3 it is the hinge model ½ D l² θ² / (A₀ + A₁), which is what hinges alone can do: on the
/// panel mesher's meshes those are off by 10 % with the direction, and have no warp and weft to speak of.
/// At an edge of the cloth, where a hinge is missing, the curvature is that of least energy: no moment across the edge.
/// Dissipation potential [W]: R = ½ β θ̇ᵀ K θ̇, θ̇ = ∇θ·v [after Sánchez-Banderas & Otaduy 2018]. Velocity derivative:
/// exact. Position derivative of the dissipative force: dropped (it is not symmetric, and of the order of the angles'
/// change in a step relative to what is kept). Angles are those of the points, whatever the neighbours' winding, so a
/// hinge is right where a stitch turns the fabric over (right_wrong). They are taken in [−π, π]: where a hinge turns
/// through π, cloth through cloth, which contact does not let it, the energy jumps.
struct BendingStencil {
  std::array<int, 6> nodes;  ///< the corners, then the tip across the edge opposite to each: where there is none, the
                             ///< corner itself, and `hinge` is false
  std::array<bool, 3> hinge{};  ///< opposite to corner i
  Mat3 factor;                  ///< F
  Vec3 rest_angle;              ///< θ₀ [rad]
  double damping;               ///< β [s]
};

/// The stencils of a cloth, and, where a fabric bends non-linearly or with friction, a law for each (else none).
struct BendingStencils {
  std::vector<BendingStencil> stencils;
  std::vector<BendingLaw> laws;  ///< of the same length, or empty; linear where BendingLaw::linear()
};

/// One stencil for each triangle that has a hinge and some bending stiffness. Each triangle bends as its own fabric;
/// neighbours' wings are unfolded into its plane. Across an edge in cloth.clamps the tangent is prescribed by the
/// clamp's tip, and a triangle that is a clamp's holding part has no stencil; an edge in cloth.creases has that rest
/// angle and its hinge's stiffness times that factor. On an edge of more than two triangles each one is hinged to the
/// next.
BendingStencils bending_stencils(const Cloth& cloth);

/// `law`: null for linear bending.
double bending_energy(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x);
StencilVector<6> bending_gradient(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x);
StencilMatrix<6> bending_hessian(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x);
/// The Gauss–Newton part ∇θ ∂²E/∂θ² ∇θᵀ, with the secant in place of the tangent where the law softens: exact at the
/// rest shape, positive semi-definite everywhere.
StencilMatrix<6> bending_hessian_psd(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x);

/// R [W]
double bending_dissipation(const BendingStencil& s, const StencilPoints<6>& x, const StencilPoints<6>& v);
/// ∂R/∂v [N] = minus the dissipative force.
StencilVector<6> bending_dissipation_gradient(const BendingStencil& s, const StencilPoints<6>& x,
                                              const StencilPoints<6>& v);
/// ∂²R/∂v² [N·s/m], positive semi-definite.
StencilMatrix<6> bending_dissipation_hessian(const BendingStencil& s, const StencilPoints<6>& x);

/// Curvature (κ_uu, κ_vv, 2 κ_uv) [1/m] beyond the rest shape's.
Vec3 bending_curvature(const BendingStencil& s, const BendingLaw& law, const StencilPoints<6>& x);

/// What bending friction may do: forces [N] on the six nodes are arm · w with any |w| ≤ 1, w the friction moment over
/// its yield surface: arm = −area ∇θ Cᵀ √P. Zero for a law without friction.
Eigen::Matrix<double, 18, 3> bending_friction_arm(const BendingStencil& s, const BendingLaw& law,
                                                  const StencilPoints<6>& x);

/// Elastic and dissipative force at once. A hinge with a triangle under 1 µm high has no angle to speak of and answers
/// with nothing (here and in bending_response).
std::array<Vec3, 6> bending_force(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x,
                                  const StencilPoints<6>& v, double fabric_factor);

/// Force, and the system's share as three rows over the nodes' coordinates: block (i, j) is rowsᵢᵀ rowsⱼ.
struct BendingResponse {
  std::array<Vec3, 6> force;
  std::array<Eigen::Matrix3f, 6> rows;
};
/// Σ rowᵀ row = stiffness · _hessian_psd + dissipation · _dissipation_hessian.
void bending_response(const BendingStencil& s, const BendingLaw* law, const StencilPoints<6>& x,
                      const StencilPoints<6>& v, const SystemWeights& weights, BendingResponse& out);

}  // namespace toile
