#include "engine/mesh/panel_outline.h"
#include "engine/mesh/pattern_pointer.h"
#include "engine/mesh/polygon.h"
#include "engine/scene/check.h"
#include "engine/scene/check_parts.h"

#include <array>
#include <cmath>
#include <set>

namespace toile {
namespace {

constexpr double kCellsAVertex = 10;    // of a meshing lattice, that cost as much as a vertex
constexpr double kLargestLength = 1e4;  // [m]; beyond, a number is an accident
constexpr int kCurveSamples = 32;       // segments a curved edge is looked at with

bool sane(double value) { return std::isfinite(value) && std::abs(value) <= kLargestLength; }
template <class Vector>
bool sane_vector(const Vector& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= kLargestLength;
}

bool sane_curve(const PatternEdge& edge) {
  if (const auto* quadratic = std::get_if<QuadraticEdge>(&edge.curve)) return sane_vector(quadratic->control);
  if (const auto* cubic = std::get_if<CubicEdge>(&edge.curve)) {
    return sane_vector(cubic->control_start) && sane_vector(cubic->control_end);
  }
  if (const auto* arc = std::get_if<ArcEdge>(&edge.curve)) return sane(arc->radius) && arc->radius > 0;
  return true;
}

/// Numbers and indices; false if the outline can't be looked at.
bool check_numbers(const Panel& panel, std::size_t garment, std::vector<Problem>& problems) {
  const std::size_t before = problems.size();
  const std::string pointer = panel_pointer(garment, panel.name);
  for (std::size_t v = 0; v < panel.vertices.size(); ++v) {
    if (sane_vector(panel.vertices[v])) continue;
    problems.push_back(
        {pointer + "/vertices/" + std::to_string(v), "not_finite", "The vertex is not finite, or beyond 10 km."});
  }
  if (!sane_vector(panel.translation)) {
    problems.push_back({pointer + "/translation", "not_finite", "The translation is not finite, or beyond 10 km."});
  }
  if (!panel.rotation.allFinite() ||
      (panel.rotation.transpose() * panel.rotation - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-6) {
    problems.push_back({pointer + "/rotation", "not_finite", "The rotation is not a rotation."});
  }
  const std::size_t n = panel.edges.size();
  if (n < 2) problems.push_back({pointer + "/edges", "too_few_edges", "A panel needs at least two edges."});
  const int count = static_cast<int>(panel.vertices.size());
  for (std::size_t e = 0; e < n; ++e) {
    const PatternEdge& edge = panel.edges[e];
    const std::string place = edge_pointer(garment, panel.name, e);
    if (edge.start < 0 || edge.start >= count || edge.end < 0 || edge.end >= count) {
      problems.push_back({place, "vertex_out_of_range", "The edge names a vertex that the panel does not have."});
    } else if (edge.end != panel.edges[(e + 1) % n].start) {
      problems.push_back({place, "open_panel_loop", "The edge does not end where the next one starts."});
    } else if (!sane_curve(edge)) {
      problems.push_back({place + "/curvature", "not_finite",
                          "The edge's curvature is not finite, has no radius, or leads beyond 10 km."});
    }
  }
  return problems.size() == before;
}

/// Whether a closed outline has no width, as against one whose loops cancel.
bool on_a_line(const std::vector<Vec2>& outline) {
  const Vec2& from = outline[0];
  Vec2 along = Vec2::Zero();
  for (const Vec2& p : outline)
    if ((p - from).norm() > along.norm()) along = p - from;
  double width = 0;
  for (const Vec2& p : outline)
    width = std::max(width, std::abs(along.x() * (p - from).y() - along.y() * (p - from).x()));
  return width <= 1e-6 * along.squaredNorm();
}

/// Shape of a panel whose numbers are sound; returns an estimate of its vertices.
double check_outline(const Panel& panel, double h, std::size_t garment, std::vector<Problem>& problems) {
  const std::size_t before = problems.size();
  std::vector<Vec2> outline;
  std::vector<std::size_t> edge_of;
  double perimeter = 0;
  for (std::size_t e = 0; e < panel.edges.size(); ++e) {
    const double length = edge_length(panel, static_cast<int>(e));
    perimeter += length;
    if (!(length > kShortestEdge)) {
      problems.push_back({edge_pointer(garment, panel.name, e), "zero_length_edge",
                          "The edge is shorter than 0.02 mm: no triangle can stand on it."});
      continue;
    }
    const bool straight = std::holds_alternative<StraightEdge>(panel.edges[e].curve);
    const std::vector<Vec2> points = sample_edge(panel, static_cast<int>(e), straight ? 1 : kCurveSamples);
    outline.insert(outline.end(), points.begin(), points.end() - 1);
    edge_of.resize(outline.size(), e);
  }
  if (problems.size() > before) return 0;
  const double area = std::abs(signed_area(panel));
  if (!(area > 1e-6 * perimeter / 2) && on_a_line(outline)) {
    problems.push_back({panel_pointer(garment, panel.name), "zero_area_panel", "The panel has no area."});
  } else if (const auto crossing = first_crossing(outline)) {
    const std::size_t a = edge_of[static_cast<std::size_t>(crossing->first)];
    const std::size_t b = edge_of[static_cast<std::size_t>(crossing->second)];
    problems.push_back({edge_pointer(garment, panel.name, a), "self_crossing_panel",
                        a == b ? "The edge crosses or touches itself."
                               : "The edge crosses or touches edge " + std::to_string(b) + " of its panel."});
  }
  // Meshing also looks at the cells of the panel's bounding box: a long strip that lies askew has many.
  Vec2 low = outline[0], high = outline[0];
  for (const Vec2& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double cells = (high - low).prod() / (h * h);
  return std::max(area / (h * h * std::sqrt(3.0) / 2) + perimeter / h, cells / kCellsAVertex);
}

void check_stitches(const Pattern& pattern, std::size_t garment, std::vector<Problem>& problems) {
  std::set<std::pair<int, int>> used;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const std::array<PatternStitch::Side, 2> sides = {pattern.stitches[s].a, pattern.stitches[s].b};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [panel, edge] = sides[k];
      const std::string place = stitch_pointer(garment, s) + "/" + std::to_string(k);
      if (panel < 0 || panel >= static_cast<int>(pattern.panels.size())) {
        problems.push_back({place, "stitch_missing_panel", "The stitch names a panel that the pattern does not have."});
        continue;
      }
      const Panel& sewn = pattern.panels[static_cast<std::size_t>(panel)];
      if (edge < 0 || edge >= static_cast<int>(sewn.edges.size())) {
        problems.push_back(
            {place, "stitch_missing_edge", "Panel " + sewn.name + " has no edge " + std::to_string(edge) + "."});
      } else if (!used.emplace(panel, edge).second) {
        problems.push_back({stitch_pointer(garment, s), "edge_stitched_twice",
                            "Edge " + std::to_string(edge) + " of panel " + sewn.name + " is already stitched."});
      }
    }
  }
}

}  // namespace

double check_pattern(const Pattern& pattern, double edge_length, std::size_t garment, std::vector<Problem>& problems) {
  const std::string pointer = garment_pointer(garment) + "/pattern/panels";
  if (pattern.panels.empty()) problems.push_back({pointer, "empty_garment", "The pattern has no panels."});
  if (pattern.panels.size() > kMaxPanels) {
    problems.push_back({pointer, "too_many_panels", "The pattern has more than 500 panels."});
    return 0;
  }
  std::set<std::string> names;
  double vertices = 0;
  for (const Panel& panel : pattern.panels) {
    const std::string place = panel_pointer(garment, panel.name);
    if (!names.insert(panel.name).second) {
      problems.push_back({place, "duplicate_panel", "Two panels have the name " + panel.name + "."});
    }
    if (check_numbers(panel, garment, problems)) vertices += check_outline(panel, edge_length, garment, problems);
    if (panel.fabric) check_fabric(*panel.fabric, place + "/fabric", problems);
  }
  check_stitches(pattern, garment, problems);
  return vertices;
}

}  // namespace toile
