#include "schemas/fabrics.h"
#include "schemas/pointer.h"
#include "schemas/read_scene.h"
#include "schemas/scene_parts.h"
#include "schemas/validate.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace toile {

namespace {

using nlohmann::json;

constexpr const char* kPointer = "/experiment";

/// The keys that a kind takes besides kind, fabric and edge_length_mm.
std::set<std::string> keys_of(const std::string& kind) {
  if (kind == "cusick_drape") return {"disc_mm", "support_mm", "starts", "lowering_s"};
  if (kind == "cantilever") return {"direction", "width_mm", "overhang_mm"};
  if (kind == "uniaxial") return {"direction", "length_mm", "width_mm", "strains_percent"};
  if (kind == "bias_extension") return {"length_mm", "width_mm", "strains_percent"};
  return {"direction", "length_mm", "width_mm"};
}

Direction read_direction(const json& document) {
  const std::string name = document.value("direction", "warp");
  return name == "weft" ? Direction::weft : name == "bias" ? Direction::bias : Direction::warp;
}

void set_millimetres(const json& document, const char* key, double& length) {
  if (document.contains(key)) length = document[key].get<double>() * 1e-3;
}

Experiment read_kind(const json& document, const Fabric& fabric) {
  const std::string kind = document.at("kind");
  if (kind == "cusick_drape") {
    CusickDrape e;
    e.fabric = fabric;
    set_millimetres(document, "disc_mm", e.disc_diameter);
    set_millimetres(document, "support_mm", e.support_diameter);
    set_millimetres(document, "edge_length_mm", e.edge_length);
    e.starts = document.value("starts", e.starts);
    e.lowering_time = document.value("lowering_s", e.lowering_time);
    return e;
  }
  const auto read_strip = [&](auto e) {
    e.fabric = fabric;
    e.direction = read_direction(document);
    set_millimetres(document, "width_mm", e.width);
    set_millimetres(document, "edge_length_mm", e.edge_length);
    return e;
  };
  if (kind == "cantilever") {
    Cantilever e = read_strip(Cantilever{});
    if (document.contains("overhang_mm")) e.overhang = document["overhang_mm"].get<double>() * 1e-3;
    return e;
  }
  if (kind == "pear_loop") {
    PearLoop e = read_strip(PearLoop{});
    set_millimetres(document, "length_mm", e.length);
    return e;
  }
  UniaxialTest e = read_strip(UniaxialTest{});
  if (kind == "bias_extension") e.direction = Direction::bias;
  set_millimetres(document, "length_mm", e.length);
  if (document.contains("strains_percent")) {
    e.strains.clear();
    for (const json& strain : document["strains_percent"]) e.strains.push_back(strain.get<double>() * 1e-2);
  }
  return e;
}

}  // namespace

bool is_experiment(const json& document) { return document.is_object() && document.contains("experiment"); }

Experiment read_experiment(const json& document) {
  validate_document("experiment.schema.json", document);
  const json& asked = document.at("experiment");
  const std::string kind = asked.at("kind");
  const std::set<std::string> keys = keys_of(kind);
  std::vector<Problem> problems;
  for (const auto& [key, value] : asked.items()) {
    if (key == "kind" || key == "fabric" || key == "edge_length_mm" || keys.contains(key)) continue;
    problems.push_back({child(kPointer, key), "key_not_of_kind", "A " + kind + " has no \"" + key + "\"."});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  Experiment experiment = read_kind(asked, read_fabric(asked.at("fabric"), child(kPointer, "fabric")));
  problems = experiment_problems(experiment);
  for (Problem& problem : problems) problem.pointer = kPointer + problem.pointer;
  if (!problems.empty()) throw InputError(std::move(problems));
  return experiment;
}

}  // namespace toile
