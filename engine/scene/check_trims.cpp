// The check of what is sewn onto a garment.
#include "engine/scene/check_parts.h"

#include <algorithm>
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

bool has_panel(const Garment& garment, const std::string& name) {
  if (const auto* pattern = std::get_if<Pattern>(&garment.shape))
    return std::any_of(pattern->panels.begin(), pattern->panels.end(), [&](const Panel& p) { return p.name == name; });
  const std::vector<std::string>& names = std::get<GarmentMesh>(garment.shape).mesh.group_names;
  return std::find(names.begin(), names.end(), name) != names.end();
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
  for (std::size_t k = 0; k < garment.trims.size(); ++k) {
    const Trim& trim = garment.trims[k];
    const std::string here = pointer + "/trims/" + std::to_string(k);
    require(within(trim.button.diameter, 1e-3, 0.2) && within(trim.button.thickness, 1e-4, 0.1) &&
                within(trim.button.mass, 1e-6, 1),
            here + "/button", "A button is 1 to 200 mm wide, 0.1 to 100 mm thick and weighs 0.001 to 1000 g.");
    require(within(trim.stiffness, 1e-3, 1e7), here + "/stiffness_N_m", "The stiffness must be 0.001 to 1e7 N/m.");
    require(within(trim.damping, 0, 1e3), here + "/damping_s", "The damping must not be negative.");
    require(within(trim.friction, 0, 10), here + "/friction", "The friction must be 0 to 10.");
    require(!trim.holes.empty(), here + "/attach", "A trim is attached somewhere.");
    for (std::size_t h = 0; h < trim.holes.size(); ++h) {
      const std::string place = here + "/attach/" + std::to_string(h);
      if (!has_panel(garment, trim.holes[h].panel))
        problems.push_back(
            {place + "/panel", "unknown_panel", "The garment has no panel \"" + trim.holes[h].panel + "\"."});
      require(trim.holes[h].at.allFinite(), place + "/at_mm", "The place is not finite.");
    }
  }
}

}  // namespace toile
