#pragma once
// Bending that is not linear in curvature, and bending friction: what a pure elastic sheet lacks.

#include "engine/types.h"

namespace toile {

/// Per rest area, over the curvature κ = (κ_uu, κ_vv, 2 κ_uv) beyond the rest shape's:
///   W = ½ κᵀ D κ · 2 ψ(s)/s² + Φ(y),   s = √(κᵀ R κ),   y = √(zᵀ P z),   z = κ − slip.
/// Softening: on a cylinder s = r |κ| with r [m] the ratio −K2/K1 of M = K1 κ + K2 κ² (Feng et al. 2022; R is the
/// directional tensor of r²), and the moment is ∂W/∂κ = D/r m(s), m = ψ′:
///   m(s) = s − s² up to s = 0.45, where the tangent is a tenth of D, and goes on with that slope: it never falls.
/// Friction (KES 2HB: twice the moment per width that friction adds when bending and takes when unbending): elastic up
/// to the onset, then sliding (Prandtl): Φ(y) = y²/(2 y₀) up to y₀, then y − y₀/2. P is the directional tensor of HB²
/// [N²], so that a sliding cylinder has the friction moment HB; y₀ [N/m] is the mean HB times the onset curvature.
/// `slip` is advanced after each accepted step, so Φ is the incremental potential of the return mapping: the step's
/// force is its exact gradient, and what slides is dissipated.
struct BendingLaw {
  double area = 0;                ///< rest area [m²]
  Mat3 fit = Mat3::Zero();        ///< C: curvature from angles [1/m]
  Mat3 stiffness = Mat3::Zero();  ///< D [N·m]
  Mat3 softening = Mat3::Zero();  ///< R [m²]; zero: none
  Mat3 friction = Mat3::Zero();   ///< P [N²]; zero: none
  double onset = 0;               ///< y₀ [N/m]; 0: no friction
  Vec3 slip = Vec3::Zero();       ///< [1/m]

  bool linear() const { return onset == 0 && softening.isZero(0); }
};

double law_energy(const BendingLaw& law, const Vec3& curvature);  ///< W [J/m²]
Vec3 law_moment(const BendingLaw& law, const Vec3& curvature);    ///< ∂W/∂κ [N]
Mat3 law_tangent(const BendingLaw& law, const Vec3& curvature);   ///< ∂²W/∂κ² [N·m], exact
/// The secant: symmetric positive definite, M = secant · κ where R is proportional to D and slip is zero; not below the
/// tangent on a cylinder, and equal to it at κ = 0.
Mat3 law_secant(const BendingLaw& law, const Vec3& curvature);

/// The slip after a step that ended at this curvature.
Vec3 advanced_slip(const BendingLaw& law, const Vec3& curvature);

}  // namespace toile
