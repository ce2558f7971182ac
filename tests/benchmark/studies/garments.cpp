// How many garments drape soundly: the public GarmentCode patterns, each as it is and varied in mesh, size, fabric and
// body, and pairs of them in layers; the last three variations are of measured fabrics on a fine mesh.
//   study_garments [garment] [variation]     only those whose names are or else contain this
// A drape is sound when it is sewn, at rest, crosses nothing and is less than 2 mm inside the body. Needs
// ../shared/data.

#include "engine/drape.h"
#include "engine/scene/problem.h"
#include "schemas/read_scene.h"
#include "tests/validation/silent.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace toile;
using namespace toile::test;
using nlohmann::json;

namespace {

const std::string kData = TOILE_SHARED "/data/";
constexpr double kDeepest = 2e-3;  // [m]

struct GarmentCase {
  std::string name, body;
  std::vector<std::string> patterns;  ///< the innermost first
};

const std::vector<GarmentCase> kCases = {
    {"circle_skirt", "mean_all", {"circle_skirt"}},
    {"fitted_shirt_collar", "mean_all", {"fitted_shirt_collar"}},
    {"godet_skirt", "mean_all", {"godet_skirt"}},
    {"hoody", "mean_all", {"hoody"}},
    {"pants", "mean_all_apart", {"pants"}},
    {"pencil_dress", "mean_all", {"pencil_dress"}},
    {"repo_hoody_mean", "mean_all", {"repo_hoody_mean"}},
    {"repo_shirt_mean", "mean_all", {"repo_shirt_mean"}},
    {"strapless_top", "mean_all", {"strapless_top"}},
    {"tshirt", "mean_all", {"tshirt"}},
    {"tshirt+pants", "mean_all_apart", {"tshirt", "pants"}},
    {"strapless_top+hoody", "mean_all", {"strapless_top", "hoody"}},
    {"tshirt+circle_skirt", "mean_all", {"tshirt", "circle_skirt"}},
    {"strapless_top+tshirt", "mean_all", {"strapless_top", "tshirt"}},
};

struct Variation {
  std::string name;
  double edge_mm = 15;
  double size = 1;  ///< of every panel about its middle
  std::string fabric = "suiting_wool_blend_twill", body = {};
};

const std::vector<Variation> kVariations = {
    {"as drawn"},
    {"edges of 20 mm", 20},
    {"edges of 12 mm", 12},
    {"3 % smaller", 15, 0.97},
    {"5 % larger", 15, 1.05},
    {"denim", 15, 1, "denim"},
    {"jersey", 15, 1, "jersey"},
    {"silk satin", 15, 1, "silk_satin"},
    {"another body", 15, 1, "suiting_wool_blend_twill", "f_smpl_average_A40"},
    {"10 mm wool", 10},
    {"10 mm polyester", 10, 1, "suiting_polyester_plain"},
    {"10 mm cotton", 10, 1, "suiting_cotton_polyester_twill"},
};

std::string bytes_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

Scene scene_of(const GarmentCase& garment, const Variation& variation) {
  json document = {
      {"body",
       {{"mesh", {{"file", kData + "bodies/" + (variation.body.empty() ? garment.body : variation.body) + ".obj"}}},
        {"friction", 0.3}}}};
  for (const std::string& pattern : garment.patterns)
    document["garments"].push_back({{"pattern", {{"file", kData + "specs/" + pattern + "_specification.json"}}},
                                    {"fabric", variation.fabric},
                                    {"edge_length_mm", variation.edge_mm}});
  Scene scene = read_scene(document, [](const json& reference, const std::string&) {
                  return bytes_of(reference.at("file").get<std::string>());
                }).scene;
  for (Garment& g : scene.garments)
    for (Panel& panel : std::get<Pattern>(g.shape).panels) {
      Vec2 middle = Vec2::Zero();
      for (const Vec2& p : panel.vertices) middle += p / static_cast<double>(panel.vertices.size());
      for (Vec2& p : panel.vertices) p = middle + variation.size * (p - middle);
      for (PatternEdge& edge : panel.edges)
        if (auto* arc = std::get_if<ArcEdge>(&edge.curve)) arc->radius *= variation.size;
    }
  return scene;
}

bool drape_and_tell(const GarmentCase& garment, const Variation& variation) {
  std::printf("%-21s %-15s ", garment.name.c_str(), variation.name.c_str());
  std::fflush(stdout);
  bool sound = false;
  try {
    Silent monitor;
    const Report r = drape(scene_of(garment, variation), monitor).report;
    sound = r.status == "converged" && r.self_intersections == 0 && r.penetration_max < kDeepest;
    std::printf("%6ld %6.0f %6ld %7.2f %7.2f %5ld %6.1f /%5.1f %7.3f  %s%s\n", r.vertices, r.time.total, r.steps,
                1e3 * r.seam_gap_max, 1e3 * r.penetration_max, r.self_intersections, 100 * r.stretch_warp.p99,
                100 * r.stretch_weft.p99, r.residual_rms, r.stop_reason.c_str(), sound ? "" : "  NOT SOUND");
  } catch (const InputError& error) {
    std::printf("refused: %s %s\n", error.problems()[0].code.c_str(), error.problems()[0].pointer.c_str());
  }
  std::fflush(stdout);
  return sound;
}

}  // namespace

int main(int count, char** words) {
  const auto wanted = [&](const auto& all, const std::string& name, int word) {
    if (count <= word || name == words[word]) return true;
    const bool other = std::any_of(all.begin(), all.end(), [&](const auto& each) { return each.name == words[word]; });
    return !other && name.find(words[word]) != std::string::npos;
  };
  std::printf("%-21s %-15s %6s %6s %6s %7s %7s %5s %13s %7s\n", "garment", "variation", "nodes", "s", "steps", "gap mm",
              "deep mm", "cross", "p99 warp/weft", "rms");
  int attempts = 0, sound = 0;
  for (const GarmentCase& garment : kCases)
    for (const Variation& variation : kVariations)
      if (wanted(kCases, garment.name, 1) && wanted(kVariations, variation.name, 2)) {
        ++attempts;
        sound += drape_and_tell(garment, variation);
      }
  std::printf("%d of %d sound\n", sound, attempts);
  return 0;
}
