#include "schemas/read_pattern.h"

#include "engine/scene/problem.h"
#include "schemas/placement.h"
#include "schemas/pointer.h"
#include "schemas/validate.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace toile {

namespace {

using nlohmann::json;

struct Conventions {
  double metres = 0.01;  ///< of one unit
  bool absolute_controls = false;
  bool recentred = false;
};

Vec2 vec2(const json& pair) { return {pair[0].get<double>(), pair[1].get<double>()}; }
Vec3 vec3_or_zero(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return Vec3::Zero();
  return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}
std::string label_of(const json& object) {
  const auto found = object.find("label");
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// A control point relative to the edge from s to e. [file units]
Vec2 relative(const Vec2& control, const Vec2& s, const Vec2& e, bool is_absolute) {
  if (!is_absolute) return control;
  const Vec2 d = e - s, n(-d.y(), d.x());
  return Vec2((control - s).dot(d), (control - s).dot(n)) / d.squaredNorm();
}

InputError wrong_curvature(const std::string& pointer, const std::string& detail) {
  return {child(pointer, "curvature"), "wrong_curvature", detail};
}

std::vector<Vec2> control_points(const json& params, std::size_t count, const std::string& pointer) {
  if (params.size() != count) {
    throw wrong_curvature(pointer, "This kind of curve has " + std::to_string(count) + " control points.");
  }
  std::vector<Vec2> points;
  for (const json& point : params) {
    if (!point.is_array()) throw wrong_curvature(pointer, "A control point is a pair of numbers.");
    points.push_back(vec2(point));
  }
  return points;
}

bool flag(const json& value, const std::string& pointer) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number() && (value == 0 || value == 1)) return value == 1;
  throw wrong_curvature(pointer, "The second and third parameter of a circle are 0 or 1.");
}

decltype(PatternEdge::curve) read_curve(const json& edge, const Vec2& s, const Vec2& e, const Conventions& conventions,
                                        const std::string& pointer) {
  const auto curvature = edge.find("curvature");
  if (curvature == edge.end() || curvature->is_null()) return StraightEdge{};
  const bool absolute = conventions.absolute_controls;
  if (curvature->is_array()) return QuadraticEdge{relative(vec2(*curvature), s, e, absolute)};
  const std::string type = curvature->at("type").get<std::string>();
  const json& params = curvature->at("params");
  if (type == "quadratic") {
    return QuadraticEdge{relative(control_points(params, 1, pointer)[0], s, e, absolute)};
  }
  if (type == "cubic") {
    const std::vector<Vec2> points = control_points(params, 2, pointer);
    return CubicEdge{relative(points[0], s, e, absolute), relative(points[1], s, e, absolute)};
  }
  if (params.size() != 3 || !params[0].is_number() || params[0].get<double>() <= 0) {
    throw wrong_curvature(pointer, "A circle has three parameters: a radius above 0, large arc, right.");
  }
  return ArcEdge{params[0].get<double>() * conventions.metres, flag(params[1], pointer), flag(params[2], pointer)};
}

/// The edges of one panel; what is wrong goes to `problems`.
std::vector<PatternEdge> read_edges(const json& edges, const std::vector<Vec2>& corners, const Conventions& conventions,
                                    const std::string& pointer, std::vector<Problem>& problems) {
  std::vector<PatternEdge> result;
  const std::size_t count = edges.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::string here = child(child(pointer, "edges"), k);
    const json& ends = edges[k].at("endpoints");
    const auto start = ends[0].get<std::size_t>(), end = ends[1].get<std::size_t>();
    if (start >= corners.size() || end >= corners.size()) {
      problems.push_back({child(here, "endpoints"), "vertex_out_of_range",
                          "The panel has " + std::to_string(corners.size()) + " vertices, counted from 0."});
      continue;
    }
    if (corners[start] == corners[end]) {
      problems.push_back({child(here, "endpoints"), "zero_length_edge", "The edge starts and ends at the same point."});
      continue;
    }
    const auto next = edges[(k + 1) % count].at("endpoints")[0].get<std::size_t>();
    if (end != next) {
      problems.push_back({here, "open_panel_loop",
                          "The edge ends at vertex " + std::to_string(end) + " but the next one starts at vertex " +
                              std::to_string(next) + "; the edges of a panel are one closed loop in list order."});
      continue;
    }
    try {
      result.push_back({static_cast<int>(start), static_cast<int>(end),
                        read_curve(edges[k], corners[start], corners[end], conventions, here), label_of(edges[k])});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  return result;
}

Panel read_panel(const std::string& name, const json& document, const Conventions& conventions,
                 const std::string& pointer, std::vector<Problem>& problems) {
  std::vector<Vec2> corners;
  for (const json& vertex : document.at("vertices")) corners.push_back(vec2(vertex));
  Vec3 translation = vec3_or_zero(document, "translation");
  if (conventions.recentred && !corners.empty()) {
    Vec2 mean = Vec2::Zero();
    for (const Vec2& corner : corners) mean += corner / static_cast<double>(corners.size());
    for (Vec2& corner : corners) corner -= mean;
    translation.head<2>() += mean;
  }
  Panel panel;
  panel.name = name;
  panel.label = label_of(document);
  panel.rotation = rotation_from_degrees(vec3_or_zero(document, "rotation"));
  panel.translation = translation * conventions.metres;
  for (const Vec2& corner : corners) panel.vertices.push_back(corner * conventions.metres);
  const json& edges = document.at("edges");
  if (edges.size() < 2) {
    problems.push_back({child(pointer, "edges"), "too_few_edges", "A panel has two edges at least."});
  } else {
    panel.edges = read_edges(edges, corners, conventions, pointer, problems);
  }
  return panel;
}

using PanelIndex = std::map<std::string, int>;

PatternStitch::Side read_side(const json& side, const json& panels, const PanelIndex& index,
                              const std::string& pointer) {
  if (!side.is_object()) throw InputError(pointer, "wrong_type", "A stitch begins with its two sides.");
  const auto name = side.at("panel").get<std::string>();
  const auto found = index.find(name);
  if (found == index.end()) {
    throw InputError(child(pointer, "panel"), "stitch_missing_panel", "The pattern has no panel \"" + name + "\".");
  }
  const auto edge = side.at("edge").get<std::size_t>();
  const std::size_t count = panels.at(name).at("edges").size();
  if (edge >= count) {
    throw InputError(child(pointer, "edge"), "stitch_missing_edge",
                     "The panel \"" + name + "\" has " + std::to_string(count) + " edges, counted from 0.");
  }
  return {found->second, static_cast<int>(edge)};
}

std::vector<PatternStitch> read_stitches(const json& stitches, const json& panels, const PanelIndex& index,
                                         const std::string& pointer, std::vector<Problem>& problems) {
  std::vector<PatternStitch> result;
  std::map<std::pair<int, int>, std::size_t> stitched;  // edge to the stitch that has it
  for (std::size_t k = 0; k < stitches.size(); ++k) {
    const json& stitch = stitches[k];
    const std::string here = child(pointer, k);
    try {
      PatternStitch::Side sides[2];
      for (std::size_t i = 0; i < 2; ++i) {
        sides[i] = read_side(stitch[i], panels, index, child(here, i));
        const auto [earlier, is_new] = stitched.try_emplace({sides[i].panel, sides[i].edge}, k);
        if (!is_new) {
          throw InputError(child(here, i), "edge_stitched_twice",
                           "This edge is in stitch " + std::to_string(earlier->second) + " already.");
        }
      }
      if (stitch.size() == 3 && !stitch[2].is_string()) {
        throw InputError(child(here, 2), "wrong_type", "The third item of a stitch is \"right_wrong\".");
      }
      result.push_back({sides[0], sides[1], stitch.size() == 3});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  return result;
}

Conventions read_conventions(const json& document, std::vector<std::string>& warnings) {
  const json properties = document.value("properties", json::object());
  Conventions conventions;
  conventions.metres = 1.0 / properties.value("units_in_meter", 100.0);
  conventions.absolute_controls = properties.value("curvature_coords", "relative") == "absolute";
  conventions.recentred = properties.value("normalize_panel_translation", false);
  if (!properties.value("normalized_edge_loops", true)) {
    warnings.push_back(
        "The pattern says that its edge loops are not normalised; they are taken as drawn, so that the right side of "
        "the fabric may be the wrong one.");
  }
  return conventions;
}

/// The schema's findings, with the document's own level `pattern` left out of the pointers.
void validate_pattern(const json& document, const std::string& pointer) {
  try {
    validate_document("pattern.schema.json", document);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      const bool inside = problem.pointer.rfind("/pattern/", 0) == 0;
      problem.pointer = pointer + (inside ? problem.pointer.substr(8) : problem.pointer);
    }
    throw InputError(std::move(problems));
  }
}

Panel flat_panel(std::string name) {
  Panel panel;
  panel.name = std::move(name);
  panel.rotation = rotation_from_degrees({-90, 0, 0});
  return panel;
}

}  // namespace

PatternDocument read_pattern(const json& document, const std::string& pointer) {
  validate_pattern(document, pointer);
  PatternDocument result;
  const Conventions conventions = read_conventions(document, result.warnings);
  const json& pattern = document.at("pattern");
  const json& panels = pattern.at("panels");
  std::vector<Problem> problems;
  PanelIndex index;
  for (const auto& [name, panel] : panels.items()) {
    index[name] = static_cast<int>(result.pattern.panels.size());
    const std::string here = child(child(pointer, "panels"), name);
    result.pattern.panels.push_back(read_panel(name, panel, conventions, here, problems));
  }
  if (const auto stitches = pattern.find("stitches"); stitches != pattern.end()) {
    result.pattern.stitches = read_stitches(*stitches, panels, index, child(pointer, "stitches"), problems);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return result;
}

Pattern rectangle_pattern(double width, double height) {
  Panel panel = flat_panel("rectangle");
  const double x = width / 2, y = height / 2;
  panel.vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  for (int k = 0; k < 4; ++k) panel.edges.push_back({k, (k + 1) % 4, StraightEdge{}, ""});
  return {{std::move(panel)}, {}};
}

Pattern disc_pattern(double radius) {
  Panel panel = flat_panel("disc");
  panel.vertices = {{radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}};
  for (int k = 0; k < 4; ++k) panel.edges.push_back({k, (k + 1) % 4, ArcEdge{radius, false, true}, ""});
  return {{std::move(panel)}, {}};
}

}  // namespace toile
