#pragma once
// One node on a slope, with the mass that the tests of admissible forces give every node.

#include "engine/contact/contact.h"
#include "engine/types.h"

#include <cmath>

namespace toile::test {

inline constexpr double kNodeMass = 1e-3, kNodeWeight = kNodeMass * kGravity;

/// A contact of one vertex with a plane through the origin that is tilted by `slope` [rad].
inline Contact slope_contact(int vertex, double slope, double friction) {
  Contact c;
  c.nodes = {vertex, 0, 0, 0};
  c.weights = {1, 0, 0, 0};
  c.count = 1;
  c.normal = Vec3(std::sin(slope), std::cos(slope), 0);
  c.friction = friction;
  return c;
}

}  // namespace toile::test
