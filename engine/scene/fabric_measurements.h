#pragma once
// What a fabric laboratory measured of one cloth, as plain structs in SI units; engine/experiments/fit_fabric.h finds
// the fabric that answers so.

#include "engine/scene/experiment.h"
#include "engine/scene/stretch_test.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace toile {

/// One number or test per direction, by static_cast<std::size_t>(Direction).
template <class T>
using ByDirection = std::array<std::optional<T>, 3>;

/// "warp", "weft" or "bias".
const char* name_of(Direction direction);
double along(const Directional& values, Direction direction);
double& along(Directional& values, Direction direction);

/// A strip pulled between grips (uniaxial.h); the bias-extension test where it is cut at 45°.
struct MeasuredPull {
  double length = 0.2, width = 0.05;  ///< between the grips, and of the strip [m]
  std::vector<ForceStrain> readings;
  /// Takes the measured curve over, corrected for the grips; else one modulus is fitted to all readings.
  bool as_curve = true;
  double uncertainty = 0.02;  ///< of a force, one standard deviation over the value
};

/// A strip over an edge (cantilever.h).
struct MeasuredCantilever {
  enum class Reading { angle, drop };
  double overhang = 0, width = 0.025;  ///< [m]
  Reading reading = Reading::angle;
  double value = 0;           ///< of the chord below the level [rad], or of the end below the edge [m]
  double uncertainty = 0.02;  ///< of that value
};

/// A hanging loop (pear_loop.h).
struct MeasuredLoop {
  double length = 0.15, width = 0.025;  ///< of the strip, between its clamped ends [m]
  double height = 0;                    ///< from the clamp down to the lowest point [m]
  double uncertainty = 0.005;           ///< of the height
};

/// A stiffness that was measured as such, as by KES: D [N·m] or G [N/m].
struct MeasuredStiffness {
  double value = 0;
  double uncertainty = 0.05;
};

struct FabricMeasurements {
  Fabric base;                          ///< gives what was not measured; its name is that of the library's fabric
  StretchTest base_stretch;             ///< the readings behind the base's stress curves
  double area_density = 0;              ///< [kg/m²]
  std::optional<double> thickness;      ///< [m]
  std::optional<double> poisson_ratio;  ///< C_poisson / √(C_warp C_weft)
  ByDirection<MeasuredPull> pulls;      ///< bias: the bias-extension test
  ByDirection<MeasuredCantilever> cantilevers;
  ByDirection<MeasuredLoop> loops;
  ByDirection<MeasuredStiffness> bending;
  std::optional<MeasuredStiffness> shear;
};

/// Everything that is wrong with them; pointers are the keys of measurements.schema.json below "". Codes: those of
/// check_fabric, strains_not_rising, curve_not_rising, measurement_value, nothing_measured.
std::vector<Problem> measurement_problems(const FabricMeasurements& measurements);

}  // namespace toile
