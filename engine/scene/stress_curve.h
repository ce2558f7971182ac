#pragma once
// One direction's stress over strain, where it was measured rather than given as one modulus.

#include "engine/types.h"

#include <algorithm>
#include <vector>

namespace toile {

/// A smooth, rising stress [N/m] over Green strain, once continuously differentiable: piecewise cubic between the
/// knots, linear with the first tangent below the first knot, which lies at (0, 0), and with the last one beyond the
/// last. No knots: the direction is linear and has its modulus elsewhere. Made by monotone_stress_curve().
struct StressCurve {
  /// stress = Σ over d = strain − this strain: stress + tangent d + quadratic d² + cubic d³
  struct Knot {
    double strain, energy;  ///< [-], ∫ stress up to here [J/m²]
    double stress, tangent, quadratic, cubic;
    bool operator==(const Knot&) const = default;
  };
  std::vector<Knot> knots;

  bool empty() const { return knots.empty(); }
  bool operator==(const StressCurve&) const = default;

  struct Value {
    double stress, tangent;  ///< [N/m]
  };
  /// Not to be asked of an empty curve.
  Value at(double strain) const {
    const Knot& k = piece(strain);
    const double d = strain - k.strain;
    if (d < 0) return {k.stress + k.tangent * d, k.tangent};
    return {k.stress + d * (k.tangent + d * (k.quadratic + d * k.cubic)),
            k.tangent + d * (2 * k.quadratic + d * 3 * k.cubic)};
  }
  /// ∫₀ stress [J/m²]
  double energy(double strain) const {
    const Knot& k = piece(strain);
    const double d = strain - k.strain;
    if (d < 0) return k.energy + d * (k.stress + 0.5 * d * k.tangent);
    return k.energy + d * (k.stress + d * (k.tangent / 2 + d * (k.quadratic / 3 + d * k.cubic / 4)));
  }
  /// At no strain [N/m].
  double initial_tangent() const { return knots.front().tangent; }
  /// The smallest anywhere [N/m].
  double least_tangent() const;

 private:
  const Knot& piece(double strain) const {
    const auto after = std::upper_bound(knots.begin() + 1, knots.end(), strain,
                                        [](double value, const Knot& knot) { return value < knot.strain; });
    return *(after - 1);
  }
};

/// The curve through (0, 0) and points (strain, stress), both rising strictly. Tangents at inner points: the weighted
/// harmonic mean of the slopes on both sides [Fritsch & Butland 1984]; at the two ends: the three-point formula, held
/// within a quarter and three times the slope beside it. So the stress rises strictly everywhere and does not
/// overshoot. A measured toe says little of the tangent at 0, of which a cloth at rest must have some: hence the
/// quarter. `additional` [N/m] times the strain is added to all.
StressCurve monotone_stress_curve(const std::vector<Vec2>& points, double additional = 0);

}  // namespace toile
