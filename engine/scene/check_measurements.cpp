#include "engine/scene/check_parts.h"
#include "engine/scene/fabric_measurements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {
namespace {

/// Height over length of a weightless pear loop; weight makes it longer [Peirce 1930].
constexpr double kWeightlessLoop = 0.4243;
/// Half of the strip, which hangs straight down in a cloth without stiffness.
constexpr double kLimpLoop = 0.5;
/// By how much a reading may lie outside of what any cloth does before it is taken for a mistake.
constexpr double kReadingError = 0.03;

class Checker {
 public:
  explicit Checker(std::vector<Problem>& problems) : problems_(problems) {}

  void pull(const MeasuredPull& test, const std::string& at) {
    sizes(test.length, test.width, at);
    uncertainty(test.uncertainty, at);
    require(!test.readings.empty(), at + "/readings", "There must be a reading.");
    require(!test.as_curve || test.readings.size() >= 2, at + "/model", "A curve needs two readings at least.");
    ForceStrain last;
    for (std::size_t i = 0; i < test.readings.size(); ++i) {
      const ForceStrain& r = test.readings[i];
      const std::string here = at + "/readings/" + std::to_string(i);
      if (!(std::isfinite(r.strain) && r.strain > last.strain)) {
        require(false, here, "The strain must be positive and greater than that of the reading before.",
                "strains_not_rising");
        return;
      }
      if (!(std::isfinite(r.force) && r.force > 0)) {
        require(false, here, "The force must be positive.");
        return;
      }
      if (test.as_curve && !(r.force > last.force && r.force / (1 + r.strain) > last.force / (1 + last.strain))) {
        require(false, here,
                "Force, and force over (1 + strain), must be greater than those of the reading before. Give fewer "
                "readings, or \"model\": \"constant\".",
                "curve_not_rising");
        return;
      }
      last = r;
    }
  }

  void cantilever(const MeasuredCantilever& test, const std::string& at) {
    sizes(test.overhang, test.width, at);
    uncertainty(test.uncertainty, at);
    if (test.reading == MeasuredCantilever::Reading::drop)
      require(test.value > 0 && test.value < test.overhang, at + "/drop_mm",
              "The end falls by less than the overhang's length.");
    else
      require(test.value > 0 && test.value < std::numbers::pi / 2, at + "/angle_deg",
              "The chord's angle lies between 0 and 90 degrees.");
  }

  void loop(const MeasuredLoop& test, double thickness, const std::string& at) {
    sizes(test.length, test.width, at);
    uncertainty(test.uncertainty, at);
    require(10 * thickness < test.length, at + "/length_mm",
            "The loop must be ten times as long as the cloth is thick.");
    const double share = test.height / test.length;
    require(share > kWeightlessLoop * (1 - kReadingError) && share < kLimpLoop * (1 + kReadingError), at + "/height_mm",
            "A loop of any cloth is between 0.4243 (no weight) and 0.5 (no stiffness) of the strip's length high; was "
            "the strip's whole length between the clamped ends given?");
  }

  void stiffness(const MeasuredStiffness& test, double low, double high, const std::string& at) {
    require(test.value >= low && test.value <= high, at, "This is no stiffness of cloth.");
    uncertainty(test.uncertainty, at);
  }

  void require(bool fine, const std::string& pointer, const char* detail, const char* code = "measurement_value") {
    if (!fine) problems_.push_back({pointer, code, detail});
  }

 private:
  void sizes(double length, double width, const std::string& at) {
    require(std::isfinite(length) && length >= 2e-3 && length <= 2, at, "The specimen's length must be 2 mm to 2 m.");
    require(std::isfinite(width) && width >= 1e-3 && width <= 1, at, "The specimen's width must be 1 mm to 1 m.");
  }
  void uncertainty(double value, const std::string& at) {
    require(value >= 1e-4 && value <= 1, at + "/uncertainty_percent", "The uncertainty must be 0.01 to 100 %.");
  }

  std::vector<Problem>& problems_;
};

}  // namespace

const char* name_of(Direction direction) {
  return direction == Direction::warp ? "warp" : direction == Direction::weft ? "weft" : "bias";
}

double along(const Directional& values, Direction direction) {
  return direction == Direction::warp ? values.warp : direction == Direction::weft ? values.weft : values.bias;
}

double& along(Directional& values, Direction direction) {
  return direction == Direction::warp ? values.warp : direction == Direction::weft ? values.weft : values.bias;
}

std::vector<Problem> measurement_problems(const FabricMeasurements& m) {
  std::vector<Problem> problems;
  Fabric fabric = m.base;
  fabric.area_density = m.area_density;
  if (m.thickness) fabric.thickness = *m.thickness;
  check_fabric(fabric, "", problems);
  Checker check(problems);
  if (m.poisson_ratio)
    check.require(*m.poisson_ratio >= 0 && *m.poisson_ratio <= 0.95, "/poisson_ratio",
                  "The ratio must lie between 0 and 0.95.");
  bool any = m.shear.has_value();
  for (std::size_t d = 0; d < 3; ++d) {
    const auto direction = static_cast<Direction>(d);
    const std::string key = std::string("/") + name_of(direction);
    if (m.pulls[d]) check.pull(*m.pulls[d], direction == Direction::bias ? "/bias_extension" : "/uniaxial" + key);
    if (m.cantilevers[d]) check.cantilever(*m.cantilevers[d], "/cantilever" + key);
    if (m.loops[d]) check.loop(*m.loops[d], fabric.thickness, "/pear_loop" + key);
    if (m.bending[d]) check.stiffness(*m.bending[d], 1e-9, 0.1, "/bending_uN_m" + key);
    any = any || m.pulls[d] || m.cantilevers[d] || m.loops[d] || m.bending[d];
  }
  if (m.shear) check.stiffness(*m.shear, 0.01, 1e6, "/shear_N_m");
  check.require(any, "", "No test of stretch, shear or bending is given.", "nothing_measured");
  return problems;
}

}  // namespace toile
