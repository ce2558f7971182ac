#pragma once
// Rotations and their small changes.

#include "engine/types.h"

namespace toile {

/// [a]×, so that cross_matrix(a) b = a × b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// exp [r]×: about r by |r| radians. Of a quaternion of length one; r = 0 is no rotation.
inline Eigen::Quaterniond rotation_by(const Vec3& r) {
  const double angle = r.norm();
  // sin(x/2)/x is even and smooth; below a nanoradian its value at 0 is exact to round-off.
  const double share = angle < 1e-9 ? 0.5 : std::sin(0.5 * angle) / angle;
  return Eigen::Quaterniond(std::cos(0.5 * angle), share * r.x(), share * r.y(), share * r.z());
}

}  // namespace toile
