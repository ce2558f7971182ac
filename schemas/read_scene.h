#pragma once
// The scene document into the engine's Scene and the pictures wanted. The only way from JSON to a run.

#include "engine/scene/experiment.h"
#include "engine/scene/scene.h"
#include "schemas/parse_json.h"

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// Turns {"file": path} or {"asset": "sha256:…"} into the bytes meant; throws InputError with the given pointer.
using Resolver = std::function<std::string(const nlohmann::json& reference, const std::string& pointer)>;

/// Pictures: each view with each overlay. Names as in scene.schema.json, without repetition.
struct RenderRequest {
  std::vector<std::string> views, overlays;
  int width = 0, height = 0;  ///< [px]
};

/// `experiment` in place of the scene, where the document is one.
struct Job {
  Scene scene;
  std::optional<Experiment> experiment = {};
  RenderRequest render;
  std::vector<std::string> warnings;  ///< for the report
};

/// Where {"file": …} is allowed.
enum class FileReferences { allowed, refused };

/// Whether a job's document is an experiment (experiment.schema.json) rather than a scene.
bool is_experiment(const nlohmann::json& document);

/// Reads {"experiment": {…}}, which refers to nothing else. Throws InputError with pointers into the document; beside
/// the schema's codes key_not_of_kind and those of experiment_problems().
Experiment read_experiment(const nlohmann::json& document);

/// What can be said of a scene or experiment without touching another document: the schema, fabrics' names, inline
/// patterns (loops, stitches). Cheap; parses no mesh. Throws InputError with JSON pointers; file_not_allowed where
/// files are refused.
void validate_scene_document(const nlohmann::json& document, FileReferences files = FileReferences::allowed);

/// The assets ("sha256:…") that a valid scene refers to, sorted, each once.
std::vector<std::string> asset_references(const nlohmann::json& document);

/// Reads a scene, or an experiment, and all that it refers to. Lengths become metres, angles rotations, names of panels
/// indices, labels to be attached pins; the whole then passes engine/scene/check.h. Throws InputError; the problems of
/// a pattern have pointers as if the pattern's own `panels` stood in the scene
/// (/garments/0/pattern/panels/NAME/edges/3), wherever its document stands.
Job read_scene(const nlohmann::json& document, const Resolver& resolve);

enum class UpAxis { y, z };

/// An OBJ or GLB (told apart by its first bytes) whose coordinates are in units of `unit` [m], turned y up. Throws
/// InputError (`bad_mesh_file`).
TriangleMesh read_mesh_bytes(std::string_view bytes, const std::string& pointer, double unit, UpAxis up);

/// For the command line: files relative to `base`, and assets in `base`/assets/<64 hex digits>. Codes file_not_found,
/// file_too_large (256 MiB), asset_not_found.
Resolver file_resolver(std::filesystem::path base);

}  // namespace toile
