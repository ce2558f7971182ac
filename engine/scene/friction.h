#pragma once
// Coulomb friction of pairs of materials, where the fabrics' own coefficients don't say it well enough.

#include <string>

namespace toile {

/// The coefficient of a pair of fabrics, by their names in either order, or of a fabric and the body.
struct FrictionPair {
  std::string fabric, other;  ///< an empty `other` is the body
  double coefficient = 0;
};

}  // namespace toile
