// The check of a garment's zippers.
#include "engine/scene/check_parts.h"

#include <cmath>
#include <set>

namespace toile {
namespace {

bool within(double value, double low, double high) { return std::isfinite(value) && value >= low && value <= high; }

bool stitched(const Pattern& pattern, const PinEdge& edge) {
  const auto is = [&](const PatternStitch::Side& side) { return side.panel == edge.panel && side.edge == edge.edge; };
  for (const PatternStitch& stitch : pattern.stitches)
    if (is(stitch.a) || is(stitch.b)) return true;
  return false;
}

void check_sides(const Zipper& zipper, const Garment& garment, const std::string& pointer,
                 std::set<std::pair<int, int>>& used, std::vector<Problem>& problems) {
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string here = pointer + "/sides/" + std::to_string(k);
    const auto* edge = std::get_if<PinEdge>(&zipper.sides[k]);
    if ((edge != nullptr) != (pattern != nullptr)) {
      problems.push_back({here, "zipper_side",
                          "The sides of a pattern's zipper are edges of its panels, those of a "
                          "mesh's chains of its vertices."});
      return;
    }
    const std::size_t before = problems.size();
    check_selection(edge ? Selection(*edge) : Selection(std::get<PinVertices>(zipper.sides[k])), garment, here,
                    problems);
    if (problems.size() > before || !edge) continue;
    if (stitched(*pattern, *edge) || !used.insert({edge->panel, edge->edge}).second)
      problems.push_back({here, "edge_stitched_twice", "The edge is sewn to another, or has a zipper already."});
  }
  const auto *a = std::get_if<PinVertices>(&zipper.sides[0]), *b = std::get_if<PinVertices>(&zipper.sides[1]);
  if (a && b && (a->vertices.size() != b->vertices.size() || a->vertices.size() < 2))
    problems.push_back({pointer + "/sides", "zipper_side", "Both sides need as many vertices, two at least."});
}

}  // namespace

void check_zippers(const Garment& garment, const std::string& pointer, std::vector<Problem>& problems) {
  std::set<std::pair<int, int>> used;
  for (std::size_t z = 0; z < garment.zippers.size(); ++z) {
    const Zipper& zipper = garment.zippers[z];
    const std::string here = pointer + "/" + std::to_string(z);
    const auto require = [&](bool fine, const char* key, const char* detail) {
      if (!fine) problems.push_back({here + "/" + key, "zipper_value", detail});
    };
    check_sides(zipper, garment, here, used, problems);
    require(within(zipper.closed_fraction, 0, 1), "closed_percent", "The closed part must be 0 to 100 %.");
    require(within(zipper.mass_per_length, 0, 1), "mass_g_m", "The mass must be 0 to 1000 g/m.");
    require(within(zipper.stiffness, 1e-3, 1e6), "stiffness_N", "The stiffness must be 0.001 to 1,000,000 N.");
    require(within(zipper.bending, 0, 1), "bending_N_mm2", "The bending stiffness must be 0 to 1,000,000 N mm².");
    require(within(zipper.damping, 0, 1e3), "damping_s", "The damping must not be negative.");
    for (const auto& [end, key] : {std::pair(&zipper.slider, "slider"), std::pair(&zipper.stop, "stops")})
      require(end->size.allFinite() && end->size.minCoeff() >= 5e-4 && end->size.maxCoeff() <= 0.2 &&
                  within(end->mass, 1e-6, 1),
              key, "An end is 0.5 to 200 mm in each direction and weighs 0.001 to 1000 g.");
    require(within(zipper.thread_stiffness, 1e-3, 1e7), "thread_stiffness_N_m",
            "The stiffness must be 0.001 to 1e7 N/m.");
    require(within(zipper.thread_damping, 0, 1e3), "thread_damping_s", "The damping must not be negative.");
    require(within(zipper.friction, 0, 10), "friction", "The friction must be 0 to 10.");
  }
}

}  // namespace toile
