#pragma once
// Exact signs of orientation determinants of doubles.

#include "engine/types.h"

namespace toile {

/// Sign of det(b − a, c − a, d − a): +1, 0 or −1, exact. A floating-point filter with Shewchuk's (1997) error bound
/// decides nearly always, otherwise the determinant is summed as an expansion without rounding. Coordinates must be
/// finite, and zero or of magnitudes between 1e-90 and 1e90.
int orientation_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of the doubled area of the triangle a, b, c: +1 counter-clockwise.
int orientation_sign(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace toile
