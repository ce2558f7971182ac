#pragma once
// One frozen contact: what collision detection hands to the solver for the duration of a step.

#include "engine/types.h"

#include <cstdint>

namespace toile {

/// A linear gap over up to four nodes. With p(x) = Σ weightᵢ·x[nodeᵢ]:
///   cloth against a body: weights ≥ 0 and sum to 1, p is the touching point of the cloth;
///   cloth against cloth (vertex–triangle, edge–edge): weights sum to 0, p is the vector between the closest points.
/// gap(x) = normal · p(x) − offset [m]; repulsion is active while gap < distance, with energy ½ k (distance − gap)²,
/// and where layers are pressed below half of it, with one that no load overcomes (terms/contact.h).
/// Coulomb friction acts in the plane across `normal`: an elastic–plastic spring from `anchor` (the value of p at which
/// the tangential spring is unloaded), which slides when its force exceeds friction · normal force. A bilateral contact
/// (an edge attached to the body that slides along it) also pulls, and rubs under pull as it does under push.
struct Contact {
  /// In a fold of the body, one feature touches several surfaces at a time, in an order that changes: the keys of these
  /// contacts differ by multiples of side_key.
  static constexpr std::uint64_t side_key = std::uint64_t{1} << 40;
  static constexpr int most_sides = 6;

  std::array<int, 4> nodes{};
  std::array<double, 4> weights{};
  int count = 0;  ///< nodes in use
  Vec3 normal = Vec3::Zero();
  double offset = 0;            ///< [m]
  double distance = 0;          ///< [m]
  double friction = 0;          ///< Coulomb coefficient
  Vec3 anchor = Vec3::Zero();   ///< [m]
  bool between_layers = false;  ///< of cloth: repulsion grows beyond any load before the gap closes
  bool bilateral = false;       ///< what leaves is pulled back: the energy holds on both sides of `distance`
  std::uint64_t key = 0;        ///< the same pair of features has the same key from step to step
};

}  // namespace toile
