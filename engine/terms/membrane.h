#pragma once
// In-plane stretch and shear: anisotropic St. Venant–Kirchhoff on constant-strain triangles, with its dissipation.

#include "engine/mesh/cloth.h"
#include "engine/terms/stencil.h"

#include <memory>

namespace toile {

/// Elastic energy of a triangle [J], with F = Ds Dm⁻¹ (3×2, columns: the images of weft and warp), E = ½ (FᵀF − I):
///   A (½ C_weft E_uu² + ½ C_warp E_vv² + C_poisson E_uu E_vv + 2 G E_uv²)  +  A K/3 max(0, J₀ − J)³.
/// where a direction's quadratic term is its integral of a measured stress where the fabric has one: ∫ S_weft dE_uu,
/// ∫ S_warp dE_vv, 2 ∫ S_shear d|E_uv| (scene/fabric.h); C and G below then are the tangents at the strain.
/// The first part is StVK [Volino, Magnenat-Thalmann & Faure 2009; the first seed's §3.2]. StVK loses its strength in
/// compression (its force falls below a principal stretch of 0.577 and is nil at 0), so a triangle could collapse for
/// nothing. The second part prevents that: J = current area / rest area, J₀ = 0.7, K = ½ (C_warp + C_weft) at rest; it
/// makes the uniaxial force monotone down to a stretch of 0, is twice continuously differentiable, finite everywhere,
/// and exactly zero in every state that a cloth takes which is free to buckle. Dissipation potential [W]
/// [Sánchez-Banderas & Otaduy 2018; the first seed's §5.3]:
///   R = ½ β A Ėᵀ C Ė,  Ė = ½ (FᵀḞ + ḞᵀF);  force −∂R/∂v,
/// with the tangents C at the current strain, so that β stays viscous over elastic stress where a curve stiffens.
/// Its stress adds to the elastic one. Velocity derivative: exact. Position derivative of the dissipative force: the
/// part through ∂E/∂x (geometric, symmetric) is kept in the response, the part through Ė(x) (not symmetric) is dropped.
struct MembraneModuli {
  double weft, warp;      ///< C [N/m]
  double poisson, shear;  ///< C_poisson, G [N/m]
};
struct MembraneCurves {
  StressCurve weft, warp, shear;  ///< an empty one: linear with its modulus
};
struct MembraneStencil {
  std::array<int, 3> nodes;
  double rest_area;       ///< [m²], positive whatever the flat winding
  Mat2 inverse_rest;      ///< Dm⁻¹ [1/m], Dm's columns: flat edges 0→1, 0→2 in (weft, warp)
  MembraneModuli moduli;  ///< at rest
  double compression;     ///< K [N/m]
  double damping;         ///< β [s]
  std::shared_ptr<const MembraneCurves> curves;  ///< of the fabric; null: linear in all directions
};

inline constexpr double kCompressionOnset = 0.7;  ///< J₀: area ratio under which compression is resisted on top of StVK

/// One stencil a triangle. Throws std::invalid_argument for a triangle of no flat area.
std::vector<MembraneStencil> membrane_stencils(const Cloth& cloth);

double membrane_energy(const MembraneStencil& s, const StencilPoints<3>& x);
StencilVector<3> membrane_gradient(const MembraneStencil& s, const StencilPoints<3>& x);
StencilMatrix<3> membrane_hessian(const MembraneStencil& s, const StencilPoints<3>& x);
/// The material part plus the geometric part of the tensile principal stresses only, plus the material part of the
/// compression term. Equals the exact Hessian wherever no principal stress is compressive.
StencilMatrix<3> membrane_hessian_psd(const MembraneStencil& s, const StencilPoints<3>& x);

/// R [W]
double membrane_dissipation(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v);
/// ∂R/∂v [N] = minus the dissipative force.
StencilVector<3> membrane_dissipation_gradient(const MembraneStencil& s, const StencilPoints<3>& x,
                                               const StencilPoints<3>& v);
/// ∂²R/∂v² [N·s/m], positive semi-definite.
StencilMatrix<3> membrane_dissipation_hessian(const MembraneStencil& s, const StencilPoints<3>& x);

/// Elastic and dissipative force at once, for line search.
std::array<Vec3, 3> membrane_force(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v,
                                   double fabric_factor);
/// Force and system blocks at once. With v = 0 the blocks are stiffness · _hessian_psd + dissipation ·
/// _dissipation_hessian; otherwise the tensile part is that of the elastic plus dissipative stress.
void membrane_response(const MembraneStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v,
                       const SystemWeights& weights, StencilResponse<3>& out);

}  // namespace toile
