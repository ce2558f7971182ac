#pragma once
// Rotations as the formats give them.

#include "engine/types.h"

namespace toile {

/// Rotation about the fixed axes x, then y, then z: Rz·Ry·Rx. Exact at multiples of 90°.
Mat3 rotation_from_degrees(const Vec3& degrees);

/// The rotation vector [rad] of the same rotation. About a single axis it keeps whole turns; about more than one it is
/// the shortest to that pose.
Vec3 rotation_vector_from_degrees(const Vec3& degrees);

}  // namespace toile
