#include "schemas/read_scene.h"

#include "engine/scene/check.h"
#include "engine/scene/problem.h"
#include "schemas/fabrics.h"
#include "schemas/pointer.h"
#include "schemas/read_pattern.h"
#include "schemas/scene_parts.h"
#include "schemas/solver_keys.h"
#include "schemas/validate.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace toile {

namespace {

using nlohmann::json;

constexpr std::string_view kBodyName = "body";  // in a pair of materials

SolverOptions read_solver(const json& document) {
  SolverOptions options;
  for_each_solver_key(options, [&](const char* key, auto& member, double unit) {
    using Member = std::decay_t<decltype(member)>;
    const auto found = document.find(key);
    if (found == document.end()) return;
    if constexpr (std::is_same_v<Member, double>) {
      member = found->template get<double>() * unit;
    } else {
      member = found->template get<Member>();
    }
  });
  return options;
}

/// The list in its order, each element once.
std::vector<std::string> read_choices(const json& render, const char* key, std::vector<std::string> otherwise) {
  const auto found = render.find(key);
  if (found == render.end()) return otherwise;
  std::vector<std::string> choices;
  for (const json& choice : *found) {
    if (std::find(choices.begin(), choices.end(), choice) == choices.end()) choices.push_back(choice);
  }
  return choices;
}

RenderRequest read_render(const json& document) {
  const std::vector<int> size = document.value("size_px", std::vector<int>{1024, 1024});
  return {read_choices(document, "views", {"front", "back"}), read_choices(document, "overlays", {"fabric"}), size[0],
          size[1]};
}

Fidelity read_fidelity(const std::string& name) {
  if (name == "preview") return Fidelity::preview;
  return name == "reference" ? Fidelity::reference : Fidelity::standard;
}

/// Calls visit(reference, pointer) for every pattern and mesh of a valid scene.
template <typename Visit>
void for_each_reference(const json& document, Visit visit) {
  const json& garments = document.at("garments");
  for (std::size_t g = 0; g < garments.size(); ++g) {
    for (const char* kind : {"pattern", "mesh"}) {
      const auto found = garments[g].find(kind);
      if (found != garments[g].end()) visit(*found, child(child("/garments", g), kind));
    }
  }
  if (document.contains("body") && document["body"].contains("mesh")) visit(document["body"]["mesh"], "/body/mesh");
}

void append(std::vector<Problem>& problems, const InputError& error) {
  problems.insert(problems.end(), error.problems().begin(), error.problems().end());
}

/// What a schema can't say of one garment.
void check_garment(const json& garment, const std::string& pointer, std::vector<Problem>& problems) {
  const auto check_fabric = [&](const json& fabric, const std::string& at) {
    try {
      read_fabric(fabric, at);
    } catch (const InputError& error) {
      append(problems, error);
    }
  };
  if (garment.contains("fabric")) check_fabric(garment["fabric"], child(pointer, "fabric"));
  if (garment.contains("panel_fabrics")) {
    for (const auto& [panel, fabric] : garment["panel_fabrics"].items()) {
      check_fabric(fabric, child(child(pointer, "panel_fabrics"), panel));
    }
  }
  if (!garment.contains("pattern")) return;
  const json& source = garment["pattern"];
  if (!source.contains("inline") && !source.contains("pattern")) return;
  try {
    read_pattern(source.value("inline", source), child(pointer, "pattern"));
  } catch (const InputError& error) {
    append(problems, error);
  }
}

}  // namespace

void validate_scene_document(const json& document, FileReferences files) {
  if (is_experiment(document)) {
    read_experiment(document);
    return;
  }
  validate_document("scene.schema.json", document);
  std::vector<Problem> problems;
  const json& garments = document.at("garments");
  for (std::size_t g = 0; g < garments.size(); ++g) check_garment(garments[g], child("/garments", g), problems);
  if (files == FileReferences::refused) {
    for_each_reference(document, [&](const json& reference, const std::string& pointer) {
      if (!reference.contains("file")) return;
      problems.push_back({child(pointer, "file"), "file_not_allowed",
                          "Files can be named on the command line only; store the document by POST /v1/assets."});
    });
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::vector<std::string> asset_references(const json& document) {
  if (is_experiment(document)) return {};
  std::set<std::string> assets;
  for_each_reference(document, [&](const json& reference, const std::string&) {
    if (reference.contains("asset")) assets.insert(reference["asset"].get<std::string>());
  });
  return {assets.begin(), assets.end()};
}

Job read_scene(const json& document, const Resolver& resolve) {
  Job job;
  if (is_experiment(document)) {
    job.experiment = read_experiment(document);
    const bool disc = std::holds_alternative<CusickDrape>(*job.experiment);
    job.render = read_render(document.value("render", json::object()));
    if (!document.contains("render") || !document["render"].contains("views"))
      job.render.views = {disc ? "top" : "front", disc ? "three-quarter" : "top"};
    return job;
  }
  validate_scene_document(document);
  const json& garments = document.at("garments");
  const bool on_body = document.contains("body");
  for (std::size_t g = 0; g < garments.size(); ++g) {
    job.scene.garments.push_back(read_garment(garments[g], child("/garments", g), resolve, on_body, job.warnings));
    Garment& garment = job.scene.garments.back();
    if (garment.name.empty()) garment.name = "garment_" + std::to_string(g);
  }
  if (on_body) job.scene.body = read_body(document["body"], "/body", resolve);
  for (const json& pair : document.value("friction_pairs", json::array())) {
    const std::string other = pair["between"][1];
    job.scene.friction_pairs.push_back(
        {pair["between"][0], other == kBodyName ? "" : other, pair["coefficient"].get<double>()});
  }
  job.scene.fidelity = read_fidelity(document.value("fidelity", "standard"));
  job.scene.solver = read_solver(document.value("solver", json::object()));
  job.render = read_render(document.value("render", json::object()));
  check_scene(job.scene);
  return job;
}

}  // namespace toile
