#pragma once
// A fabric found from measurements, and how well it answers to them; in SI units.

#include "engine/scene/fabric.h"
#include "engine/scene/stretch_test.h"

#include <optional>
#include <string>
#include <vector>

namespace toile {

/// One reading beside what the fitted fabric does.
struct MisfitRow {
  enum class Quantity { force, angle, drop, height, bending, shear };  ///< [N/m], [rad], [m], [m], [N·m], [N/m]
  std::string pointer;                                                 ///< of the reading in measurements.schema.json
  Quantity quantity = Quantity::force;
  std::optional<double> strain;  ///< of a force
  double measured = 0, fitted = 0;
  double uncertainty = 0;  ///< of the measured value, one standard deviation over it
};

/// One fitted parameter.
struct ParameterEstimate {
  std::string pointer;           ///< of the key in fabric.schema.json
  std::optional<double> strain;  ///< of a curve's correction, whose value is a factor on the measured force there
  double value = 0;              ///< stiffness [N/m] or [N·m], or the factor
  double standard_error = 0;     ///< over the value; infinite where the measurements say nothing
  bool determined = false;       ///< known to better than a factor of 1.6
};

/// How the parameters of stretch, or those of bending, were found.
struct FitPart {
  std::string name;  ///< "stretch" or "bending"
  std::vector<ParameterEstimate> parameters;
  /// Of the Jacobian of (readings over uncertainty) by (logarithms of the parameters), falling: one under 1 is a
  /// combination of parameters that may change by a factor e before the readings tell.
  std::vector<double> singular_values;
  int iterations = 0;   ///< Levenberg–Marquardt steps tried
  int corrections = 0;  ///< times that the meshes' error was measured anew
  bool converged = false;
  std::string stop_reason;  ///< "no_better", "too_many_iterations", "specimen_failed", "mesh_error_unsettled"
};

struct FabricFit {
  Fabric fabric;
  StretchTest stretch;      ///< readings of strips with free sides that make the fabric's stress curves
  std::string status;       ///< "fitted" or "not_fitted"
  std::string stop_reason;  ///< "fitted", "misfit_too_large", "no_such_fabric", or that of the part that failed
  std::vector<MisfitRow> misfit;
  double rms = 0;                   ///< of fitted over measured minus one
  double rms_over_uncertainty = 0;  ///< of the same over each reading's uncertainty
  std::vector<FitPart> parts;
  std::vector<std::string> kept;  ///< keys of fabric.schema.json whose values are the base's
  std::vector<std::string> warnings;
  long simulations = 0;  ///< experiments carried out
  double time = 0;       ///< [s]
};

}  // namespace toile
