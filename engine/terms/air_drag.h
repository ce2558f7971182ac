#pragma once
// Drag that dissipates the velocity of the whole system (the first seed's equation 5).

#include "engine/types.h"

namespace toile {

/// Dissipation potential R = ½ α m |v|² [W], α [1/s].
inline double air_drag_dissipation(double alpha, double mass, const Vec3& v) {
  return 0.5 * alpha * mass * v.squaredNorm();
}
/// ∂R/∂v = α m v [N]; the force is its negative.
inline Vec3 air_drag_dissipation_gradient(double alpha, double mass, const Vec3& v) { return alpha * mass * v; }
/// ∂²R/∂v² = α m · identity [kg/s]; this is the scalar.
inline double air_drag_dissipation_hessian(double alpha, double mass) { return alpha * mass; }

}  // namespace toile
