#include "schemas/placement.h"

#include <cmath>
#include <numbers>

namespace toile {

namespace {

/// Rotation by `degrees` in the plane of axes i and j, from i to j.
Mat3 plane_rotation(int i, int j, double degrees) {
  double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  // A panel turned by 90° lies in its plane exactly, not 6e-17 beside it.
  if (std::fmod(degrees, 90.0) == 0) {
    c = std::round(c);
    s = std::round(s);
  }
  Mat3 r = Mat3::Identity();
  r(i, i) = c;
  r(j, j) = c;
  r(i, j) = -s;
  r(j, i) = s;
  return r;
}

}  // namespace

Mat3 rotation_from_degrees(const Vec3& degrees) {
  return plane_rotation(0, 1, degrees.z()) * plane_rotation(2, 0, degrees.y()) * plane_rotation(1, 2, degrees.x());
}

Vec3 rotation_vector_from_degrees(const Vec3& degrees) {
  if ((degrees.array() != 0).count() <= 1) return degrees * (std::numbers::pi / 180);
  const Eigen::AngleAxisd rotation(rotation_from_degrees(degrees));
  return rotation.angle() * rotation.axis();
}

}  // namespace toile
