#pragma once
// The fixed-size linear algebra types that every part of the engine shares. SI units unless a name says otherwise.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace toile {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

/// Three vertex indices of a triangle, in winding order.
using Triangle = std::array<int, 3>;

/// One three-number block per vertex: positions [m], velocities [m/s], forces [N].
using Positions = std::vector<Vec3>;

/// Standard gravity [m/s²], pointing down the y axis (y is up).
inline constexpr double kGravity = 9.81;

}  // namespace toile
