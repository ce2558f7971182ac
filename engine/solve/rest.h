#pragma once
// When a drape is at rest (the first seed's §5.4).

#include "engine/scene/solver_options.h"

#include <span>

namespace toile {

/// The 99th percentile of the values (nearest rank); 0 of none.
double percentile_99(std::span<const double> values);

/// At rest: the 99th percentile of nodal kinetic energy stayed below rest_kinetic_energy throughout the last
/// rest_window seconds.
class RestDetector {
 public:
  explicit RestDetector(const SolverOptions& options)
      : threshold_(options.rest_kinetic_energy), window_(options.rest_window) {}
  /// To be called after each accepted step of length h with the kinetic energy of each node [J]; says whether it is at
  /// rest.
  bool update(std::span<const double> nodal_kinetic_energy, double h);
  /// Starts the window anew, as after the relaxation, whose velocities mean nothing.
  void reset() { quiet_ = 0; }
  double percentile() const { return percentile_; }  ///< of the last update [J]

 private:
  double threshold_, window_, quiet_ = 0, percentile_ = 0;
};

}  // namespace toile
