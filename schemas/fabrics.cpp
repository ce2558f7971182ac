#include "schemas/fabrics.h"

#include "engine/scene/problem.h"
#include "engine/scene/stretch_test.h"
#include "schemas/pointer.h"
#include "schemas/resource.h"
#include "schemas/validate.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace toile {

namespace {

using nlohmann::json;

constexpr std::string_view kFolder = "fabrics/", kEnding = ".json";

json library_document(const std::string& name, const std::string& pointer) {
  if (auto document = fabric_document(name)) return *std::move(document);
  std::string names;
  for (const std::string& known : fabric_names()) names += (names.empty() ? "" : ", ") + known;
  throw InputError(pointer, "unknown_fabric", "The library has no fabric \"" + name + "\"; it has " + names + ".");
}

Directional directional(const json& numbers, double unit) {
  return {numbers.at("warp").get<double>() * unit, numbers.at("weft").get<double>() * unit,
          numbers.at("bias").get<double>() * unit};
}

std::vector<ForceStrain> readings(const json& curves, const char* direction) {
  std::vector<ForceStrain> list;
  for (const json& reading : curves.value(direction, json::array()))
    list.push_back({reading.at("strain_percent").get<double>() * 1e-2, reading.at("force_N_m").get<double>()});
  return list;
}

Fabric from_complete(const json& document, const std::string& pointer) {
  Fabric fabric;
  fabric.name = document.at("name").get<std::string>();
  fabric.area_density = document.at("area_density_g_m2").get<double>() * 1e-3;
  fabric.stretch_stiffness = directional(document.at("stretch_N_m"), 1);
  fabric.poisson_stiffness = document.at("poisson_ratio").get<double>() *
                             std::sqrt(fabric.stretch_stiffness.warp * fabric.stretch_stiffness.weft);
  fabric.bending_stiffness = directional(document.at("bending_uN_m"), 1e-6);
  if (const auto softening = document.find("bending_softening_mm"); softening != document.end())
    fabric.bending_softening = directional(*softening, 1e-3);
  if (const auto loop = document.find("bending_hysteresis_uN"); loop != document.end())
    fabric.bending_hysteresis = directional(*loop, 1e-6);
  fabric.bending_hysteresis_onset = document.value("bending_hysteresis_onset_per_m", fabric.bending_hysteresis_onset);
  fabric.thickness = document.at("thickness_mm").get<double>() * 1e-3;
  fabric.friction_cloth = document.at("friction_cloth").get<double>();
  fabric.friction_body = document.at("friction_body").get<double>();
  fabric.membrane_damping = document.at("damping_s").at("membrane").get<double>();
  fabric.bending_damping = document.at("damping_s").at("bending").get<double>();
  fabric.woven = document.at("woven").get<bool>();
  if (document.contains("stretch_curve")) {
    apply_stretch_test(stretch_test(document), document.at("poisson_ratio").get<double>(),
                       child(pointer, "stretch_curve"), fabric);
  }
  return fabric;
}

}  // namespace

std::vector<std::string> fabric_names() {
  std::vector<std::string> names;
  for (const std::string_view name : resource_names()) {
    if (name.substr(0, kFolder.size()) != kFolder) continue;
    names.emplace_back(name.substr(kFolder.size(), name.size() - kFolder.size() - kEnding.size()));
  }
  return names;
}

std::optional<json> fabric_document(std::string_view name) {
  const std::string_view bytes = resource(std::string(kFolder) + std::string(name) + std::string(kEnding));
  if (bytes.empty()) return std::nullopt;
  return json::parse(bytes);
}

StretchTest stretch_test(const json& document) {
  const json curves = document.value("stretch_curve", json::object());
  return {readings(curves, "warp"), readings(curves, "weft"), readings(curves, "bias")};
}

Fabric read_fabric(const json& name_or_document, const std::string& pointer) {
  validate_document("fabric.schema.json", name_or_document, pointer);
  if (name_or_document.is_string()) {
    return from_complete(library_document(name_or_document.get<std::string>(), pointer), pointer);
  }
  const std::string base = name_or_document.value("base", "poplin");
  const std::string base_pointer = name_or_document.contains("base") ? child(pointer, "base") : pointer;
  json document = library_document(base, base_pointer);
  document["name"] = base + " (changed)";
  document.update(name_or_document);
  return from_complete(document, pointer);
}

}  // namespace toile
