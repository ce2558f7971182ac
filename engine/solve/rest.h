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

/// Damping that gives way to creep. Near-critical damping (the seed's §5.3) is far from it where little drives a lot of
/// bending: the tip of a developable cone that moves through the sheet bends every triangle that it passes, the more
/// sharply the finer the mesh, and creeps by a millimetre a second under forces of many vertices' weight. So while the
/// drape is quiet (RestDetector) and out of balance, damping is halved once a window, down to 1/64 (too little to tell
/// from the integrator's own); what gets loud again gets all of it back. No equilibrium depends on it.
class DampingRelief {
 public:
  explicit DampingRelief(const SolverOptions& options) : window_(options.rest_window) {}
  /// To be called after each accepted step of length h; returns the factor on the fabrics' damping from now on.
  double update(bool quiet, bool balanced, double h);

 private:
  double window_, waited_ = 0, factor_ = 1;
};

}  // namespace toile
