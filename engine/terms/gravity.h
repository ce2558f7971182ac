#pragma once
// Weight.

#include "engine/types.h"

namespace toile {

/// E = m g y [J], y up.
inline double gravity_energy(double mass, const Vec3& x) { return mass * kGravity * x.y(); }
/// ∂E/∂x = m g ŷ [N]; the force is its negative, the Hessian is zero.
inline Vec3 gravity_gradient(double mass) { return {0, mass * kGravity, 0}; }

}  // namespace toile
