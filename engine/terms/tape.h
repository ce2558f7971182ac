#pragma once
// Bending of a tape along a line of vertices: what a zipper's chain resists.

#include "engine/terms/stencil.h"

namespace toile {

/// Two neighbouring segments, their unit tangents t₁ and t₂, and l̄ the mean of their lengths at rest:
///   E = ½ (B/l̄) |t₂ − t₁|² [J]: on a circle of radius R it is ½ B/R² a length up to (l̄/R)². The tape is straight at
/// rest, whatever it is sewn to, bends alike in every direction, and does not twist (a discrete elastic rod without
/// twist, Bergou et al. 2008, with the chord in place of 2 tan(φ/2)).
/// With J = ∂(t₂ − t₁)/∂x, the Hessian that is always positive semi-definite is (B/l̄) JᵀJ, exact where it is straight.
/// Dissipation [W], Kelvin–Voigt: R = ½ β (B/l̄) |J v|². The position derivative of the dissipative force is dropped.
struct TapeStencil {
  std::array<int, 3> nodes;
  double length;   ///< l̄ [m], positive
  double bending;  ///< B [N·m²]
  double damping;  ///< β [s]
};

double tape_energy(const TapeStencil& s, const StencilPoints<3>& x);
StencilVector<3> tape_gradient(const TapeStencil& s, const StencilPoints<3>& x);
StencilMatrix<3> tape_hessian(const TapeStencil& s, const StencilPoints<3>& x);
StencilMatrix<3> tape_hessian_psd(const TapeStencil& s, const StencilPoints<3>& x);

double tape_dissipation(const TapeStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v);  ///< R [W]
StencilVector<3> tape_dissipation_gradient(const TapeStencil& s, const StencilPoints<3>& x, const StencilPoints<3>& v);
StencilMatrix<3> tape_dissipation_hessian(const TapeStencil& s, const StencilPoints<3>& x);

}  // namespace toile
