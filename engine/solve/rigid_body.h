#pragma once
// A trim as a rigid body: its inertia, and where it is.

#include "engine/types.h"

#include <cmath>

namespace toile {

/// Principal axes along the body frame's, centre of mass at its origin.
struct RigidBody {
  double mass = 0;              ///< [kg]
  Vec3 inertia = Vec3::Zero();  ///< principal moments [kg·m²]
  /// ρ: root of the largest moment over the mass [m]; rotations are unknowns as ρ times their angle, so that their
  /// blocks of the system weigh as much as those of positions.
  double gyration() const { return std::sqrt(inertia.maxCoeff() / mass); }
};

/// A disc of even density, its axis along z.
inline RigidBody disc_body(double mass, double diameter, double thickness) {
  const double radial = mass * (0.75 * diameter * diameter + thickness * thickness) / 12;
  return {mass, {radial, radial, mass * diameter * diameter / 8}};
}

/// A box of even density.
inline RigidBody box_body(double mass, const Vec3& size) {
  const Vec3 squares = size.cwiseAbs2();
  return {mass, mass / 12 * (squares.sum() - squares.array()).matrix()};
}

struct RigidState {
  Vec3 center = Vec3::Zero();                                       ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< body frame to world, of length one
  Vec3 velocity = Vec3::Zero();                                     ///< [m/s]
  Vec3 angular_velocity = Vec3::Zero();                             ///< in the world's frame [rad/s]
};

/// R diag(inertia) Rᵀ [kg·m²]
inline Mat3 world_inertia(const RigidBody& body, const Mat3& orientation) {
  return orientation * body.inertia.asDiagonal() * orientation.transpose();
}
/// [kg·m²/s]
inline Vec3 angular_momentum(const RigidBody& body, const RigidState& state) {
  return world_inertia(body, state.orientation.toRotationMatrix()) * state.angular_velocity;
}

/// [J]
inline double kinetic_energy_of(const RigidBody& body, const RigidState& state) {
  return 0.5 * body.mass * state.velocity.squaredNorm() +
         0.5 * state.angular_velocity.dot(angular_momentum(body, state));
}

}  // namespace toile
