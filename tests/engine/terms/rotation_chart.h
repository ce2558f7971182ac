#pragma once
// Rotation vectors as a chart of the orientations, for the checker of derivatives.

#include "engine/geometry/rotation.h"

#include <cmath>

namespace toile::test {

/// Derivative of exp([r]×) with respect to r, as a rotation vector on the left: ∂(exp(r) a) = (J ∂r) × exp(r) a.
inline Mat3 left_jacobian(const Vec3& r) {
  const double t = r.norm();
  const Mat3 k = cross_matrix(r);
  if (t < 1e-3) return Mat3::Identity() + (0.5 - t * t / 24) * k + (1.0 / 6 - t * t / 120) * k * k;
  return Mat3::Identity() + (1 - std::cos(t)) / (t * t) * k + (t - std::sin(t)) / (t * t * t) * k * k;
}

}  // namespace toile::test
