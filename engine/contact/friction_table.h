#pragma once
// Which Coulomb coefficient holds between which materials.

#include "engine/scene/fabric.h"
#include "engine/scene/friction.h"

#include <vector>

namespace toile {

/// Coefficients by index into Cloth::fabrics.
struct FrictionTable {
  std::vector<double> cloth;  ///< row by row, symmetric
  std::vector<double> body;   ///< of each fabric against the body
  double between(int a, int b) const { return cloth[static_cast<std::size_t>(a) * body.size() + b]; }
};

/// The pair rule. Cloth on cloth: what `pairs` says, else the mean of both fabrics' friction_cloth (a fabric against
/// itself: its own). Cloth on body: what `pairs` says, else `body_friction` where it is not negative, else the fabric's
/// friction_body. Of several entries for one pair the last counts; names of no fabric here are passed over.
FrictionTable friction_table(const std::vector<Fabric>& fabrics, double body_friction,
                             const std::vector<FrictionPair>& pairs);

}  // namespace toile
