#include "engine/scene/problem.h"
#include "schemas/fabrics.h"
#include "schemas/placement.h"
#include "schemas/pointer.h"
#include "schemas/read_pattern.h"
#include "schemas/scene_parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

namespace toile {

namespace {

using nlohmann::json;

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

void move(Pattern& pattern, const Mat3& rotation, const Vec3& translation) {
  for (Panel& panel : pattern.panels) {
    panel.rotation = rotation * panel.rotation;
    panel.translation = rotation * panel.translation + translation;
  }
}

void move(GarmentMesh& garment, const Mat3& rotation, const Vec3& translation) {
  for (Vec3& vertex : garment.mesh.vertices) vertex = rotation * vertex + translation;
}

GarmentMesh read_garment_mesh(const json& source, const std::string& pointer, const Resolver& resolve) {
  GarmentMesh garment;
  garment.mesh = read_mesh(source, pointer, resolve);
  garment.uv_unit = source.value("uv_unit_mm", 1000.0) * 1e-3;
  const json seams = source.value("seams", json::array());
  const auto count = static_cast<int>(garment.mesh.vertices.size());
  for (std::size_t k = 0; k < seams.size(); ++k) {
    const auto a = seams[k][0].get<int>(), b = seams[k][1].get<int>();
    if (a >= count || b >= count) {
      throw InputError(child(child(pointer, "seams"), k), "vertex_out_of_range",
                       "The mesh has " + std::to_string(count) + " vertices, counted from 0.");
    }
    garment.seams.emplace_back(a, b);
  }
  return garment;
}

std::variant<Pattern, GarmentMesh> read_shape(const json& document, const std::string& pointer, const Resolver& resolve,
                                              std::vector<std::string>& warnings) {
  if (document.contains("mesh")) return read_garment_mesh(document["mesh"], child(pointer, "mesh"), resolve);
  if (document.contains("rectangle")) {
    const json& size = document["rectangle"];
    return rectangle_pattern(size["width_mm"].get<double>() * 1e-3, size["height_mm"].get<double>() * 1e-3);
  }
  if (document.contains("disc")) return disc_pattern(document["disc"]["radius_mm"].get<double>() * 1e-3);
  const std::string here = child(pointer, "pattern");
  PatternDocument read = read_pattern(pattern_document(document["pattern"], here, resolve), here);
  for (const std::string& warning : read.warnings) warnings.push_back(here + ": " + warning);
  return std::move(read.pattern);
}

/// Names of panels, or of the groups of a mesh.
std::vector<std::string> part_names(const Garment& garment) {
  if (const auto* mesh = std::get_if<GarmentMesh>(&garment.shape)) return mesh->mesh.group_names;
  std::vector<std::string> names;
  for (const Panel& panel : std::get<Pattern>(garment.shape).panels) names.push_back(panel.name);
  return names;
}

void require_part(const std::vector<std::string>& names, const std::string& name, const std::string& pointer) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw InputError(child(pointer, name), "unknown_panel", "The garment has no panel \"" + name + "\".");
}

void read_panel_grain(const json& grains, const std::string& pointer, Garment& garment) {
  const std::vector<std::string> names = part_names(garment);
  for (const auto& [name, grain] : grains.items()) {
    require_part(names, name, pointer);
    garment.panel_grain[name] = grain.get<double>() * kRadiansPerDegree;
  }
}

void read_panel_fabrics(const json& fabrics, const std::string& pointer, Garment& garment) {
  const std::vector<std::string> names = part_names(garment);
  for (const auto& [name, fabric] : fabrics.items()) {
    require_part(names, name, pointer);
    garment.panel_fabrics[name] = read_fabric(fabric, child(pointer, name));
  }
  if (auto* pattern = std::get_if<Pattern>(&garment.shape)) {
    for (Panel& panel : pattern->panels) {
      const auto found = garment.panel_fabrics.find(panel.name);
      if (found != garment.panel_fabrics.end()) panel.fabric = found->second;
    }
  }
}

}  // namespace

Vec3 read_vector(const json& object, const char* key, const Vec3& otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

Vec3 read_millimetres(const json& object, const char* key) { return read_vector(object, key) * 1e-3; }

json pattern_document(const json& source, const std::string& pointer, const Resolver& resolve) {
  if (source.contains("pattern")) return source;
  if (source.contains("inline")) return source["inline"];
  try {
    return parse_json(resolve(source, pointer));
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.code.rfind("json_", 0) == 0) problem.pointer = pointer + problem.pointer;
    }
    throw InputError(std::move(problems));
  }
}

Garment read_garment(const json& document, const std::string& pointer, const Resolver& resolve, bool on_body,
                     std::vector<std::string>& warnings) {
  Garment garment;
  garment.name = document.value("name", "");
  garment.shape = read_shape(document, pointer, resolve, warnings);
  const json transform = document.value("transform", json::object());
  const Mat3 rotation = rotation_from_degrees(read_vector(transform, "rotate_deg"));
  std::visit([&](auto& shape) { move(shape, rotation, read_millimetres(transform, "translate_mm")); }, garment.shape);
  garment.fabric = read_fabric(document.value("fabric", json("poplin")), child(pointer, "fabric"));
  read_panel_fabrics(document.value("panel_fabrics", json::object()), child(pointer, "panel_fabrics"), garment);
  garment.grain = document.value("grain_deg", 0.0) * kRadiansPerDegree;
  read_panel_grain(document.value("panel_grain_deg", json::object()), child(pointer, "panel_grain_deg"), garment);
  garment.edge_length = document.value("edge_length_mm", 15.0) * 1e-3;

  const json pins = document.value("pins", json::array());
  for (std::size_t k = 0; k < pins.size(); ++k) {
    garment.pins.push_back(read_pin(pins[k], garment, child(child(pointer, "pins"), k), on_body));
  }
  garment.seam_bending.stiffness_factor = document.value("seams", json::object()).value("bending_factor", 1.0);
  const json folds = document.value("folds", json::array());
  for (std::size_t k = 0; k < folds.size(); ++k)
    garment.folds.push_back(read_fold(folds[k], garment, child(child(pointer, "folds"), k)));
  read_trims(document, pointer, garment);
  if (const auto* pattern = std::get_if<Pattern>(&garment.shape)) {
    for (Pin& pin : attached_pins(document, *pattern, pointer, on_body)) garment.pins.push_back(std::move(pin));
  } else if (document.contains("attach") && document["attach"].is_array() && !document["attach"].empty()) {
    throw InputError(child(pointer, "attach"), "unknown_label", "A mesh has no edge labels.");
  }
  return garment;
}

}  // namespace toile
