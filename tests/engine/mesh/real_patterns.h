#pragma once
// The public patterns of ../shared and what an independent importer found in them.

#include "engine/scene/pattern.h"
#include "engine/scene/scene.h"
#include "schemas/read_pattern.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace toile {

inline const std::filesystem::path kShared = std::filesystem::path(TOILE_SHARED) / "data";

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline Pattern real_pattern(const std::string& name) {
  return read_pattern(nlohmann::json::parse(file_bytes(kShared / "specs" / (name + "_specification.json")))).pattern;
}

inline nlohmann::json expected_values(const std::string& name) {
  return nlohmann::json::parse(file_bytes(kShared / "expected" / (name + ".json")));
}

inline const std::vector<std::string> kRealPatterns = {
    "circle_skirt", "fitted_shirt_collar", "godet_skirt",     "hoody",         "pants",
    "pencil_dress", "repo_hoody_mean",     "repo_shirt_mean", "strapless_top", "tshirt"};

inline Scene scene_of(Pattern pattern, double edge_length) {
  Scene scene;
  scene.garments.emplace_back();
  scene.garments[0].shape = std::move(pattern);
  scene.garments[0].edge_length = edge_length;
  return scene;
}

inline int panel_named(const Pattern& pattern, const std::string& name) {
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    if (pattern.panels[p].name == name) return static_cast<int>(p);
  }
  return -1;
}

/// Runs a test once per real pattern; skips where ../shared is absent.
class RealPattern : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kShared)) GTEST_SKIP() << "needs " << kShared;
  }
};

inline Panel square_panel(const std::string& name, double side) {
  Panel panel;
  panel.name = name;
  panel.vertices = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  for (int e = 0; e < 4; ++e) panel.edges.push_back({e, (e + 1) % 4, StraightEdge{}, ""});
  return panel;
}

}  // namespace toile
