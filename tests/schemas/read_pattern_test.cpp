#include "schemas/read_pattern.h"

#include "engine/scene/problem.h"
#include "schemas/parse_json.h"
#include "tests/schemas/files.h"
#include "tests/schemas/pattern_geometry.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;
using testing::pattern_from;
using testing::problems_of;

/// A square with one curved edge, sewn to itself so that stitches are there.
json square() {
  return json::parse(R"({
    "pattern": {
      "panels": {"front": {"translation": [1, 2, 3], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [10, 0], [10, 10], [0, 10]],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2], "label": "lower_interface"},
                  {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
        "label": "body"}},
      "stitches": [[{"panel": "front", "edge": 1}, {"panel": "front", "edge": 3}]]},
    "properties": {"units_in_meter": 100, "curvature_coords": "relative", "normalized_edge_loops": true}})");
}

class PublicPatterns : public ::testing::TestWithParam<const char*> {};

TEST_P(PublicPatterns, AgreesWithIndependentValues) {
  const std::string shared = TOILE_SHARED "/data/";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "needs ../shared";
  const std::string name = GetParam();
  const Pattern pattern = pattern_from(shared + "specs/" + name + "_specification.json");
  const json expected = testing::json_from(shared + "expected/" + name + ".json");
  ASSERT_EQ(pattern.panels.size(), expected["panels"].size());
  for (const Panel& panel : pattern.panels) {
    SCOPED_TRACE(panel.name);
    const json& e = expected["panels"][panel.name];
    const double area = e["area_m2"].get<double>();
    EXPECT_NEAR(std::abs(testing::signed_area(panel)), area, 2e-6 * area);
    EXPECT_EQ(testing::signed_area(panel) > 0, e["loop"] == "ccw");
    const Vec3 normal = testing::outward_normal(panel);
    ASSERT_EQ(panel.edges.size(), e["edge_lengths_m"].size());
    for (std::size_t k = 0; k < panel.edges.size(); ++k) {
      const double length = e["edge_lengths_m"][k].get<double>();
      EXPECT_NEAR(testing::length(panel, static_cast<int>(k)), length, 1e-6 * length + 1e-7) << "edge " << k;
      const Vec3 corner = testing::placed(panel, panel.vertices[panel.edges[k].start]);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(corner[i], e["corners_3d_m"][k][i].get<double>(), 1e-6);
    }
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(normal[i], e["outward_normal"][i].get<double>(), 1e-6);
  }
  ASSERT_EQ(pattern.stitches.size(), expected["seams"].size());
  for (std::size_t k = 0; k < pattern.stitches.size(); ++k) {
    const PatternStitch& stitch = pattern.stitches[k];
    const json& e = expected["seams"][k];
    EXPECT_EQ(pattern.panels[stitch.a.panel].name, e["a"][0]);
    EXPECT_EQ(stitch.a.edge, e["a"][1]);
    EXPECT_EQ(pattern.panels[stitch.b.panel].name, e["b"][0]);
    EXPECT_EQ(stitch.b.edge, e["b"][1]);
    EXPECT_EQ(stitch.right_wrong, e["right_wrong"]);
  }
}

INSTANTIATE_TEST_SUITE_P(Specs, PublicPatterns,
                         ::testing::Values("circle_skirt", "fitted_shirt_collar", "godet_skirt", "hoody", "pants",
                                           "pencil_dress", "repo_hoody_mean", "repo_shirt_mean", "strapless_top",
                                           "tshirt"),
                         [](const auto& spec) { return std::string(spec.param); });

TEST(ReadPattern, KeepsLabelsAndPlacement) {
  const Pattern pattern = read_pattern(square()).pattern;
  ASSERT_EQ(pattern.panels.size(), 1u);
  EXPECT_EQ(pattern.panels[0].label, "body");
  EXPECT_EQ(pattern.panels[0].edges[1].label, "lower_interface");
  EXPECT_EQ(pattern.panels[0].translation, Vec3(0.01, 0.02, 0.03));
  EXPECT_EQ(pattern.panels[0].vertices[2], Vec2(0.1, 0.1));
}

TEST(ReadPattern, RotatesAboutFixedAxesXThenYThenZ) {
  json document = square();
  document["pattern"]["panels"]["front"]["rotation"] = {90, 90, 0};
  const Panel panel = read_pattern(document).pattern.panels[0];
  // x → x → −z; y → z → x.
  EXPECT_EQ(panel.rotation * Vec3(1, 0, 0), Vec3(0, 0, -1));
  EXPECT_EQ(panel.rotation * Vec3(0, 1, 0), Vec3(1, 0, 0));
}

TEST(ReadPattern, ScalesEverythingByTheUnitWithTheRadius) {
  json document = square();
  document["properties"]["units_in_meter"] = 1000;
  document["pattern"]["panels"]["front"]["edges"][0]["curvature"] = {{"type", "circle"}, {"params", {8, 0, 1}}};
  const Panel panel = read_pattern(document).pattern.panels[0];
  EXPECT_DOUBLE_EQ(panel.vertices[2].x(), 0.01);
  EXPECT_DOUBLE_EQ(panel.translation.z(), 0.003);
  const auto arc = std::get<ArcEdge>(panel.edges[0].curve);
  EXPECT_DOUBLE_EQ(arc.radius, 0.008);
  EXPECT_TRUE(arc.right);
  EXPECT_FALSE(arc.large_arc);
}

TEST(ReadPattern, ReadsTheLegacyBareCurvatureAsQuadratic) {
  json document = square();
  document["pattern"]["panels"]["front"]["edges"][1]["curvature"] = {0.5, 0.2};
  const Panel panel = read_pattern(document).pattern.panels[0];
  EXPECT_EQ(std::get<QuadraticEdge>(panel.edges[1].curve).control, Vec2(0.5, 0.2));
}

TEST(ReadPattern, TurnsAbsoluteControlPointsIntoRelativeOnes) {
  json document = square();
  document["properties"]["curvature_coords"] = "absolute";
  document["pattern"]["panels"]["front"]["edges"][1]["curvature"] = {{"type", "quadratic"}, {"params", {{12, 5}}}};
  const Panel panel = read_pattern(document).pattern.panels[0];
  // The edge goes up from (10, 0): halfway along, 2 of 10 to its right.
  EXPECT_TRUE(std::get<QuadraticEdge>(panel.edges[1].curve).control.isApprox(Vec2(0.5, -0.2)));
}

TEST(ReadPattern, MovesTheMeanToTheTranslationUnrotated) {
  json document = square();
  document["properties"]["normalize_panel_translation"] = true;
  document["pattern"]["panels"]["front"]["rotation"] = {0, 0, 90};
  const Panel panel = read_pattern(document).pattern.panels[0];
  EXPECT_TRUE(panel.vertices[0].isApprox(Vec2(-0.05, -0.05)));
  EXPECT_TRUE(panel.translation.isApprox(Vec3(0.06, 0.07, 0.03)));
}

TEST(ReadPattern, WarnsOfLoopsThatAreNotNormalised) {
  EXPECT_TRUE(read_pattern(square()).warnings.empty());
  json document = square();
  document["properties"]["normalized_edge_loops"] = false;
  EXPECT_EQ(read_pattern(document).warnings.size(), 1u);
}

TEST(ReadPattern, IgnoresKeysOfOthers) {
  json document = square();
  document["author"] = {{"name", 1}};
  document["pattern"]["panels"]["front"]["edges"][0]["colour"] = "red";
  document["properties"]["body"] = "mean_all";
  EXPECT_EQ(read_pattern(document).pattern.panels[0].edges.size(), 4u);
}

struct Fault {
  const char* name;
  const char* patch;  // RFC 6902
  const char* pointer;
  const char* code;
};

class PatternFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(PatternFaults, AreReportedWithTheirPlace) {
  const json document = square().patch(json::parse(GetParam().patch));
  const std::vector<Problem> problems = problems_of([&] { read_pattern(document, "/garments/0/pattern"); });
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].pointer, std::string("/garments/0/pattern") + GetParam().pointer);
  EXPECT_EQ(problems[0].code, GetParam().code);
  EXPECT_FALSE(problems[0].detail.empty());
}

#define EDGES "/pattern/panels/front/edges"
INSTANTIATE_TEST_SUITE_P(
    All, PatternFaults,
    ::testing::Values(
        Fault{"OpenLoop", R"([{"op":"remove","path":")" EDGES R"(/2"}])", "/panels/front/edges/1", "open_panel_loop"},
        Fault{"VertexOutOfRange", R"([{"op":"replace","path":")" EDGES R"(/0/endpoints/1","value":9}])",
              "/panels/front/edges/0/endpoints", "vertex_out_of_range"},
        Fault{"ZeroLength", R"([{"op":"replace","path":"/pattern/panels/front/vertices/1","value":[0,0]}])",
              "/panels/front/edges/0/endpoints", "zero_length_edge"},
        Fault{"NoEdges", R"([{"op":"replace","path":")" EDGES R"(","value":[]}])", "/panels/front/edges",
              "too_few_edges"},
        Fault{"MissingPanel", R"([{"op":"replace","path":"/pattern/stitches/0/1/panel","value":"back"}])",
              "/stitches/0/1/panel", "stitch_missing_panel"},
        Fault{"MissingEdge", R"([{"op":"replace","path":"/pattern/stitches/0/0/edge","value":4}])",
              "/stitches/0/0/edge", "stitch_missing_edge"},
        Fault{"StitchedTwice", R"([{"op":"add","path":"/pattern/stitches/1",
              "value":[{"panel":"front","edge":0},{"panel":"front","edge":3}]}])",
              "/stitches/1/1", "edge_stitched_twice"},
        Fault{"StitchedToItself", R"([{"op":"replace","path":"/pattern/stitches/0/1/edge","value":1}])",
              "/stitches/0/1", "edge_stitched_twice"},
        Fault{"StitchSideIsText", R"([{"op":"replace","path":"/pattern/stitches/0/1","value":"right_wrong"}])",
              "/stitches/0/1", "wrong_type"},
        Fault{"ThirdItemIsASide", R"([{"op":"add","path":"/pattern/stitches/0/2","value":{"panel":"front","edge":0}}])",
              "/stitches/0/2", "wrong_type"},
        Fault{"CubicWithOneControl",
              R"([{"op":"add","path":")" EDGES R"(/0/curvature","value":{"type":"cubic","params":[[0.5,0.5]]}}])",
              "/panels/front/edges/0/curvature", "wrong_curvature"},
        Fault{"CircleWithoutRadius",
              R"([{"op":"add","path":")" EDGES R"(/0/curvature","value":{"type":"circle","params":[0,0,1]}}])",
              "/panels/front/edges/0/curvature", "wrong_curvature"},
        Fault{"CircleFlagIsTwo",
              R"([{"op":"add","path":")" EDGES R"(/0/curvature","value":{"type":"circle","params":[9,2,1]}}])",
              "/panels/front/edges/0/curvature", "wrong_curvature"},
        Fault{"UnknownCurve",
              R"([{"op":"add","path":")" EDGES R"(/0/curvature","value":{"type":"spline","params":[[0,0]]}}])",
              "/panels/front/edges/0/curvature/type", "not_allowed"},
        Fault{"TextForANumber", R"([{"op":"replace","path":"/pattern/panels/front/vertices/1/0","value":"ten"}])",
              "/panels/front/vertices/1/0", "wrong_type"},
        Fault{"NoPanels", R"([{"op":"replace","path":"/pattern/panels","value":{}}])", "/panels", "wrong_size"},
        Fault{"UnitZero", R"([{"op":"replace","path":"/properties/units_in_meter","value":0}])",
              "/properties/units_in_meter", "out_of_range"},
        Fault{"NoPattern", R"([{"op":"remove","path":"/pattern"}])", "", "missing_key"}),
    [](const auto& fault) { return std::string(fault.param.name); });

TEST(ReadPattern, ReportsAllFindings) {
  json document = square();
  document["pattern"]["panels"]["front"]["edges"][0]["endpoints"] = {0, 9};
  document["pattern"]["stitches"][0][1]["panel"] = "back";
  EXPECT_GE(problems_of([&] { read_pattern(document); }).size(), 2u);
}

TEST(ReadPattern, EscapesNamesInPointers) {
  json document = square();
  document["pattern"]["stitches"] = json::array();
  document["pattern"]["panels"]["a/b~c"] = document["pattern"]["panels"]["front"];
  document["pattern"]["panels"]["a/b~c"]["edges"].erase(3);
  EXPECT_EQ(problems_of([&] { read_pattern(document); })[0].pointer, "/panels/a~1b~0c/edges/2");
}

TEST(BuiltInShapes, LieRightSideUp) {
  for (const Pattern& pattern : {rectangle_pattern(0.4, 0.3), disc_pattern(0.15)}) {
    ASSERT_EQ(pattern.panels.size(), 1u);
    EXPECT_EQ(testing::outward_normal(pattern.panels[0]), Vec3(0, 1, 0));
  }
  EXPECT_NEAR(testing::signed_area(rectangle_pattern(0.4, 0.3).panels[0]), 0.12, 1e-12);
  EXPECT_NEAR(testing::signed_area(disc_pattern(0.15).panels[0]), M_PI * 0.15 * 0.15, 1e-7);
  EXPECT_NEAR(testing::placed(rectangle_pattern(0.4, 0.3).panels[0], {0.2, 0.15}).z(), -0.15, 1e-15);
}

}  // namespace
}  // namespace toile
