// The check of what is sewn onto a garment.
#include "engine/scene/check_parts.h"

#include <cmath>

namespace toile {
namespace {

bool within(double value, double low, double high) { return std::isfinite(value) && value >= low && value <= high; }

void check_edges(const Selection& select, const Garment& garment, const std::string& pointer,
                 std::vector<Problem>& problems) {
  if (std::holds_alternative<PinNearest>(select)) {
    problems.push_back({pointer, "selects_no_edge", "One vertex is no edge."});
    return;
  }
  check_selection(select, garment, pointer, problems);
}

}  // namespace

void check_trims(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems) {
  const auto require = [&](bool fine, const std::string& place, const char* detail) {
    if (!fine) problems.push_back({place, "trim_value", detail});
  };
  const auto check_band = [&](const Selection& select, double stiffness, double damping, const std::string& here) {
    check_edges(select, garment, here, problems);
    require(within(stiffness, 1e-3, 1e6), here + "/stiffness_N", "The stiffness must be 0.001 to 1,000,000 N.");
    require(within(damping, 0, 1e3), here + "/damping_s", "The damping must not be negative.");
  };
  for (std::size_t k = 0; k < garment.elastics.size(); ++k) {
    const Elastic& elastic = garment.elastics[k];
    const std::string here = pointer + "/elastics/" + std::to_string(k);
    check_band(elastic.select, elastic.stiffness, elastic.damping, here);
    require(within(elastic.length_factor, 0.05, 2), here + "/length_percent", "The length must be 5 to 200 %.");
  }
  for (std::size_t k = 0; k < garment.drawcords.size(); ++k) {
    const Drawcord& cord = garment.drawcords[k];
    const std::string here = pointer + "/drawcords/" + std::to_string(k);
    check_band(cord.select, cord.stiffness, cord.damping, here);
    require(within(cord.length, 1e-3, 100), here + "/length_mm", "The length must be 1 mm to 100 m.");
  }
}

}  // namespace toile
