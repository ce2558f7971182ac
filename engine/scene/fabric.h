#pragma once
// A fabric: everything of a textile that the drape depends on, in SI units.

#include "engine/scene/stress_curve.h"

#include <cmath>
#include <string>

namespace toile {

/// One number per fabric direction. Warp runs along v of Cloth::flat, weft along u, bias at 45°: a panel's +y and +x
/// where its grain is not turned.
struct Directional {
  double warp = 0;
  double weft = 0;
  double bias = 0;
  bool operator==(const Directional&) const = default;
};

/// The least D on the bias that a sheet can have whose D in warp and weft are these, (√warp − √weft)² / 4: with less,
/// some saddle would give energy back.
inline double least_bias_bending(double warp, double weft) {
  const double difference = std::sqrt(warp) - std::sqrt(weft);
  return 0.25 * difference * difference;
}

/// Anisotropic sheet. Membrane energy density (St. Venant–Kirchhoff, per rest area):
///   W = ½ C_weft E_uu² + ½ C_warp E_vv² + C_poisson E_uu E_vv + 2 G E_uv²,   E = ½ (FᵀF − I).
/// A direction that was measured has a stress curve S(E) in place of its modulus: ∫ S_weft dE_uu, ∫ S_warp dE_vv,
/// 2 ∫ S_shear dE_uv with S_shear odd in E_uv (stretch_test.h makes them from readings); its stretch_stiffness then is
/// the tangent at rest.
/// Bending energy as in terms/bending.h, with softening and friction as in terms/bending_law.h.
struct Fabric {
  std::string name;
  double area_density = 0;                             ///< [kg/m²]
  Directional stretch_stiffness;                       ///< C_warp, C_weft [N/m]; bias: the shear modulus G [N/m]
  double poisson_stiffness = 0;                        ///< C_poisson, the coupling C12 [N/m]; C12² < C_warp C_weft
  StressCurve warp_stress, weft_stress, shear_stress;  ///< empty: linear
  Directional bending_stiffness;                       ///< the textile (cylindrical) D per width [N·m]
  /// −K2/K1 of the moment K1 κ + K2 κ² [m]; 0: linear. Typically 1 to 5 mm (Feng et al. 2022, 251 fabrics).
  Directional bending_softening;
  Directional bending_hysteresis;        ///< KES 2HB: width of the moment's loop per width of cloth [N]; 0: none
  double bending_hysteresis_onset = 20;  ///< curvature at which that friction slides [1/m]
  double thickness = 0;                  ///< [m]
  double friction_cloth = 0;             ///< Coulomb coefficient against itself
  double friction_body = 0;              ///< Coulomb coefficient against bodies, where the body gives none
  double membrane_damping = 1e-2;        ///< beta_s of the first seed's §5.3 [s]
  double bending_damping = 1e-1;         ///< beta_b of the first seed's §5.3 [s]
  bool woven = true;                     ///< false for knits; the report's stretch warnings depend on it
  bool operator==(const Fabric&) const = default;
};

/// (D/(ρ g))^⅓ [m] with the mean D of warp, weft and bias: how far its own weight lets cloth stand off (Peirce 1930).
inline double bending_length(const Fabric& fabric) {
  const Directional& d = fabric.bending_stiffness;
  return std::cbrt((d.warp + d.weft + d.bias) / 3 / (fabric.area_density * kGravity));
}

}  // namespace toile
