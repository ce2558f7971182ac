#include "engine/solve/rest.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace toile {

double percentile_99(std::span<const double> values) {
  if (values.empty()) return 0;
  std::vector<double> sorted(values.begin(), values.end());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(sorted.size()))) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[rank];
}

bool RestDetector::update(std::span<const double> nodal_kinetic_energy, double h) {
  percentile_ = percentile_99(nodal_kinetic_energy);
  quiet_ = percentile_ < threshold_ ? quiet_ + h : 0;
  // The sum of many equal steps may end a rounding error short of the window.
  return quiet_ >= window_ * (1 - 1e-9);
}

double DampingRelief::update(bool quiet, bool balanced, double h) {
  constexpr double kLeast = 1.0 / 64;
  if (!quiet) factor_ = 1;
  waited_ = quiet && !balanced ? waited_ + h : 0;
  if (waited_ >= window_ * (1 - 1e-9) && factor_ > kLeast) {
    factor_ *= 0.5;
    waited_ = 0;
  }
  return factor_;
}

}  // namespace toile
