#pragma once
// Curvature of a triangle from the angles of its hinges: the quadratic surface that fits the triangle and its
// neighbours.

#include "engine/scene/fabric.h"
#include "engine/types.h"

namespace toile {

/// Curvatures are (κ_uu, κ_vv, 2 κ_uv) [1/m] in the flat pattern's (weft, warp) frame; positive where a ridge is seen
/// from the right side. A cylinder of curvature κ bent along (cos φ, sin φ) has (cos²φ, sin²φ, 2 sin φ cos φ) κ.

/// The tensor T with κᵀ T κ = T(φ) κ² on cylinders, T(0) = weft, T(90°) = warp, T(±45°) = bias: of an orthotropic
/// plate with T(φ) = weft cos⁴φ + warp sin⁴φ + (4 bias − warp − weft) sin²φ cos²φ. Cylinders do not tell T₁₂ from T₆₆;
/// without coupling (T₁₂ = 0) a narrow strip, which may curl sideways, bends as the cylinder does, which is how D is
/// measured. So T₁₂ = 0, but where bias is below (warp + weft)/4 (+ a hundredth of √(warp·weft)): then T₁₂ < 0, no
/// lower than −0.99 √(warp·weft), and a bias that asks for less is not reached. Positive semi-definite.
Mat3 directional_tensor(const Directional& values);

/// A wing of a flat hinge: height of its tip over the edge and the tip's foot from the edge's start [m].
struct Wing {
  double height, foot;
};

/// Row b with θ = b · κ [m] for a hinge whose vertices lie on a quadratic surface of curvature κ. `along` is the unit
/// vector of the edge, `across` the unit normal from it into the triangle `near`. From the jump of the slopes of the
/// two linear interpolants:
///   θ = ½ (h + h′) κ_nn + (s − s′) κ_nt − ½ (s (l − s)/h + s′ (l − s′)/h′) κ_tt
Vec3 hinge_row(const Vec2& along, const Vec2& across, double length, const Wing& near, const Wing& far);

/// The same where the surface's tangent at the edge's middle is that of a rigid far wing, which has no curvature:
///   θ = ½ h κ_nn + (s − l/2) κ_nt − ½ s (l − s)/h κ_tt
Vec3 clamped_hinge_row(const Vec2& along, const Vec2& across, double length, const Wing& near);

/// What the hinges' angles θ − θ₀ of a triangle say about its curvature: κ = fit · (θ − θ₀), of all curvatures that
/// agree with the angles the one with the least bending energy (with three hinges there is one only), and the quadratic
/// form K = area · fitᵀ D fit = area (B D⁻¹ Bᵀ)⁻¹ of its energy ½ (θ − θ₀)ᵀ K (θ − θ₀).
struct CurvatureFit {
  Mat3 fit;     ///< [1/m], column i belongs to hinge i
  Mat3 factor;  ///< F [√(N·m)] with K = Fᵀ F
};

/// `rows` holds the hinges' rows, of which those with `present` count; D positive definite. Near a conic through all
/// six vertices the angles say little about some curvature; singular values of B below a fifth of the largest are
/// raised to that, so that such triangles do not lock. A triangle or neighbour of no area has no fit and no stiffness.
CurvatureFit fit_curvature(const std::array<Vec3, 3>& rows, const std::array<bool, 3>& present, const Mat3& stiffness,
                           double area);

}  // namespace toile
