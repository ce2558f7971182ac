#include "engine/mesh/build_cloth.h"

#include "engine/mesh/obj.h"
#include "engine/mesh/panel_outline.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/topology.h"
#include "engine/scene/check.h"
#include "engine/scene/problem.h"
#include "tests/engine/mesh/real_patterns.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

namespace toile {
namespace {

Vec3 normal_of(const Cloth& cloth, std::size_t t) {
  const auto at = [&](std::size_t i) { return cloth.x[static_cast<std::size_t>(cloth.triangles[t][i])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

const LabelledVertices& labelled(const Cloth& cloth, const std::string& name) {
  for (const LabelledVertices& label : cloth.labels) {
    if (label.label == name) return label;
  }
  throw std::runtime_error("no label " + name);
}

std::string problem_of(const Scene& scene) {
  try {
    build_cloth(scene);
  } catch (const InputError& error) {
    return error.problems()[0].code + " " + error.problems()[0].pointer;
  }
  return "none";
}

class RealCloth : public RealPattern {};

TEST_P(RealCloth, SewsIntoTheTopologyOfTheGarment) {
  const Pattern pattern = real_pattern(GetParam());
  const nlohmann::json expected = expected_values(GetParam())["sewn_topology"];
  for (const double h : {0.04, 0.015, 0.009}) {
    Cloth cloth = build_cloth(scene_of(pattern, h));
    const std::size_t triangles = cloth.triangles.size();
    merge_seams(cloth);
    EXPECT_TRUE(cloth.seam_pairs.empty());
    EXPECT_EQ(cloth.triangles.size(), triangles) << "no triangle collapses";
    EXPECT_TRUE(non_manifold_edges(cloth.triangles).empty());
    const std::vector<int> component = connected_components(cloth.triangles);
    EXPECT_EQ(1 + *std::max_element(component.begin(), component.end()), expected["components"].get<int>());
    EXPECT_EQ(euler_characteristic(cloth.triangles), expected["euler_characteristic"].get<long>());
    EXPECT_EQ(boundary_loops(cloth.triangles).size(), expected["boundary_loops"].get<std::size_t>());
  }
}

TEST_P(RealCloth, TurnsOverExactlyAlongRightWrongSeams) {
  const Pattern pattern = real_pattern(GetParam());
  Cloth cloth = build_cloth(scene_of(pattern, 0.015));
  std::size_t turned_edges = 0;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    if (!pattern.stitches[s].right_wrong) continue;
    for (const SeamPair& pair : cloth.seam_pairs) turned_edges += pair.seam == static_cast<int>(s);
    --turned_edges;
  }
  merge_seams(cloth);
  std::size_t inconsistent = 0;
  for (const Hinge& hinge : hinges(cloth.triangles)) {
    const Triangle& b = cloth.triangles[static_cast<std::size_t>(hinge.triangle_b)];
    for (std::size_t i = 0; i < 3; ++i) inconsistent += b[i] == hinge.v0 && b[(i + 1) % 3] == hinge.v1;
  }
  EXPECT_EQ(inconsistent, turned_edges);
}

TEST_P(RealCloth, PanelsAreWoundOutwardAndKeepTheirFlatShape) {
  const Pattern pattern = real_pattern(GetParam());
  const Cloth cloth = build_cloth(scene_of(pattern, 0.015));
  std::vector<double> area(pattern.panels.size(), 0), signed_flat(pattern.panels.size(), 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const auto p = static_cast<std::size_t>(cloth.triangle_panel[t]);
    const Vec3 normal = normal_of(cloth, t);
    ASSERT_GT(normal.dot(outward_normal(pattern.panels[p])), 0);
    const auto& flat = cloth.flat[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 placed = to_world(pattern.panels[p], flat[i]);
      ASSERT_LT((placed - cloth.x[static_cast<std::size_t>(cloth.triangles[t][i])]).norm(), 1e-12);
    }
    area[p] += normal.norm() / 2;
    const Vec2 u = flat[1] - flat[0], v = flat[2] - flat[0];
    signed_flat[p] += (u.x() * v.y() - u.y() * v.x()) / 2;
  }
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const double exact = signed_area(pattern.panels[p]);
    EXPECT_NEAR(area[p], std::abs(exact), 0.02 * std::abs(exact)) << pattern.panels[p].name;
    EXPECT_NEAR(signed_flat[p], std::copysign(area[p], exact), 1e-9);
  }
  EXPECT_TRUE(cloth.warnings.empty());
}

TEST_P(RealCloth, SeamsJoinEqualFractionsOfBothEdges) {
  const Pattern pattern = real_pattern(GetParam());
  const double h = 0.012;
  const Cloth cloth = build_cloth(scene_of(pattern, h));
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const PatternStitch& stitch = pattern.stitches[s];
    const auto name = [&](const PatternStitch::Side& side) {
      return pattern.panels[static_cast<std::size_t>(side.panel)].name + "/" + std::to_string(side.edge);
    };
    const std::vector<int>& a = labelled(cloth, name(stitch.a)).vertices;
    std::vector<int> b = labelled(cloth, name(stitch.b)).vertices;
    const auto longest = std::max(edge_length(pattern.panels[static_cast<std::size_t>(stitch.a.panel)], stitch.a.edge),
                                  edge_length(pattern.panels[static_cast<std::size_t>(stitch.b.panel)], stitch.b.edge));
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(static_cast<double>(a.size() - 1), std::ceil(longest / h - 1e-9));
    if (!stitch.right_wrong) std::reverse(b.begin(), b.end());
    std::set<std::pair<int, int>> pairs;
    for (const SeamPair& pair : cloth.seam_pairs) {
      if (pair.seam == static_cast<int>(s)) pairs.emplace(pair.a, pair.b);
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_TRUE(a[i] == b[i] || pairs.count({a[i], b[i]})) << cloth.seam_names[s];
    }
  }
}

TEST_P(RealCloth, PassesTheSceneCheck) {
  for (const Problem& problem : scene_problems(scene_of(real_pattern(GetParam()), 0.015))) {
    EXPECT_EQ(problem.code, "fabric_value") << problem.pointer << ": " << problem.detail;  // the scene here has none
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealCloth, testing::ValuesIn(kRealPatterns));

TEST(BuildCloth, DartClosesToOneInnerTip) {
  Panel panel;
  panel.name = "front";
  panel.vertices = {{0, 0}, {0.1, 0}, {0.12, 0.1}, {0.14, 0}, {0.3, 0}, {0.3, 0.3}, {0, 0.3}};
  for (int e = 0; e < 7; ++e) panel.edges.push_back({e, (e + 1) % 7, StraightEdge{}, ""});
  Pattern pattern;
  pattern.panels = {panel};
  pattern.stitches = {{{0, 1}, {0, 2}, false}};
  Cloth cloth = build_cloth(scene_of(pattern, 0.01));
  const int tip = labelled(cloth, "front/1").vertices.back();
  for (const SeamPair& pair : cloth.seam_pairs) EXPECT_NE(pair.a, pair.b);
  EXPECT_NEAR(seam_gap_max(cloth), 0.04, 1e-12);
  const std::vector<int> root = seam_representatives(cloth);
  const std::size_t before = cloth.x.size(), pairs = cloth.seam_pairs.size();
  const std::vector<int> merged = merge_seams(cloth);
  EXPECT_EQ(cloth.x.size(), before - pairs);
  for (std::size_t v = 0; v < before; ++v) {
    EXPECT_EQ(merged[v], merged[static_cast<std::size_t>(root[v])]);
    EXPECT_LE(root[v], static_cast<int>(v));
  }
  EXPECT_EQ(euler_characteristic(cloth.triangles), 1);
  EXPECT_EQ(boundary_loops(cloth.triangles).size(), 1U);
  for (const auto& loop : boundary_loops(cloth.triangles)) {
    EXPECT_THAT(loop, testing::Not(testing::Contains(merged[static_cast<std::size_t>(tip)])));
  }
  EXPECT_NEAR(
      cloth.x[static_cast<std::size_t>(merged[static_cast<std::size_t>(labelled(cloth, "front/0").vertices.back())])]
          .x(),
      0.12, 0.3);
}

TEST(BuildCloth, FourPanelsMeetInOneVertexAtTheMean) {
  Pattern pattern;
  const double s = 0.1, gap = 0.02;
  for (int p = 0; p < 4; ++p) {
    Panel panel = square_panel(std::string(1, static_cast<char>('a' + p)), s);
    panel.translation = Vec3((p % 2) * (s + gap), (p / 2) * (s + gap), 0);
    pattern.panels.push_back(panel);
  }
  pattern.stitches = {
      {{0, 1}, {1, 3}, false}, {{2, 1}, {3, 3}, false}, {{0, 2}, {2, 0}, false}, {{1, 2}, {3, 0}, false}};
  Cloth cloth = build_cloth(scene_of(pattern, 0.02));
  const int corner = labelled(cloth, "a/1").vertices.back();
  const std::vector<int> merged = merge_seams(cloth);
  const Vec3 middle(s + gap / 2, s + gap / 2, 0);
  EXPECT_LT((cloth.x[static_cast<std::size_t>(merged[static_cast<std::size_t>(corner)])] - middle).norm(), 1e-12);
  EXPECT_EQ(euler_characteristic(cloth.triangles), 1);
  EXPECT_EQ(boundary_loops(cloth.triangles).size(), 1U);
  EXPECT_TRUE(std::is_sorted(labelled(cloth, "a/0").vertices.begin(), labelled(cloth, "a/0").vertices.end()));
}

TEST(BuildCloth, FabricsAndLabelsFindTheirPanels) {
  Pattern pattern;
  for (const char* name : {"a", "b", "c"}) pattern.panels.push_back(square_panel(name, 0.1));
  pattern.panels[0].edges[2].label = pattern.panels[1].edges[2].label = "lower_interface";
  Fabric lace;
  lace.name = "lace";
  pattern.panels[1].fabric = lace;
  pattern.panels[2].fabric = lace;
  Scene scene = scene_of(pattern, 0.02);
  scene.garments[0].fabric.name = "poplin";
  scene.garments[0].panel_fabrics["c"].name = "denim";
  const Cloth cloth = build_cloth(scene);
  const auto fabric = [&](std::size_t p) {
    return cloth.fabrics[static_cast<std::size_t>(cloth.panels[p].fabric)].name;
  };
  EXPECT_EQ(fabric(0), "poplin");
  EXPECT_EQ(fabric(1), "lace");
  EXPECT_EQ(fabric(2), "denim");
  EXPECT_EQ(labelled(cloth, "lower_interface").vertices.size(), 12U);
  EXPECT_EQ(labelled(cloth, "a/0").vertices.size(), 6U);
}

TEST(BuildCloth, SaysWhereAPatternIsWrong) {
  Pattern good;
  good.panels = {square_panel("a~/b", 0.1), square_panel("b", 0.1)};
  EXPECT_EQ(problem_of(scene_of(good, 0.02)), "none");

  Pattern twice = good;
  twice.stitches = {{{0, 1}, {1, 3}, false}, {{0, 1}, {1, 2}, false}};
  EXPECT_EQ(problem_of(scene_of(twice, 0.02)), "edge_stitched_twice /garments/0/pattern/stitches/1");

  Pattern self = good;
  self.stitches = {{{0, 1}, {0, 1}, false}};
  EXPECT_EQ(problem_of(scene_of(self, 0.02)), "edge_stitched_twice /garments/0/pattern/stitches/0");

  Pattern missing = good;
  missing.stitches = {{{0, 1}, {1, 4}, false}};
  EXPECT_EQ(problem_of(scene_of(missing, 0.02)), "stitch_missing_edge /garments/0/pattern/stitches/0/1");
  missing.stitches = {{{7, 1}, {1, 2}, false}};
  EXPECT_EQ(problem_of(scene_of(missing, 0.02)), "stitch_missing_panel /garments/0/pattern/stitches/0/0");

  Pattern open = good;
  open.panels[0].edges[2].end = 0;
  EXPECT_EQ(problem_of(scene_of(open, 0.02)), "open_panel_loop /garments/0/pattern/panels/a~0~1b/edges/2");

  Pattern crossing = good;
  std::swap(crossing.panels[1].vertices[2], crossing.panels[1].vertices[3]);
  crossing.panels[1].vertices[2].x() = 0.03;
  EXPECT_EQ(problem_of(scene_of(crossing, 0.02)), "self_crossing_panel /garments/0/pattern/panels/b");

  Pattern flat = good;
  for (Vec2& v : flat.panels[1].vertices) v.y() = 0;
  flat.panels[1].vertices[2].x() = 0.05;
  EXPECT_EQ(problem_of(scene_of(flat, 0.02)).substr(0, 4), "zero");

  Pattern huge = good;
  huge.panels[0] = square_panel("a", 100);
  EXPECT_EQ(problem_of(scene_of(huge, 0.01)), "too_many_vertices /garments/0");
}

TEST(BuildCloth, GrainTurnsTheFlatShapeAndNothingElse) {
  Pattern pattern;
  pattern.panels = {square_panel("a", 0.1), square_panel("b", 0.1)};
  Scene scene = scene_of(pattern, 0.02);
  const Cloth straight = build_cloth(scene);
  scene.garments[0].grain = std::numbers::pi / 6;
  scene.garments[0].panel_grain["b"] = -std::numbers::pi / 2;
  const Cloth turned = build_cloth(scene);
  EXPECT_EQ(straight.x, turned.x);
  EXPECT_EQ(straight.triangles, turned.triangles);
  for (std::size_t t = 0; t < turned.triangles.size(); ++t) {
    const bool first = turned.triangle_panel[t] == 0;
    // Where the warp runs in the drawing has the flat direction +v.
    const double grain = first ? std::numbers::pi / 6 : -std::numbers::pi / 2;
    const Vec2 warp(-std::sin(grain), std::cos(grain)), weft(std::cos(grain), std::sin(grain));
    for (std::size_t k = 1; k < 3; ++k) {
      const Vec2 drawn = straight.flat[t][k] - straight.flat[t][0], flat = turned.flat[t][k] - turned.flat[t][0];
      EXPECT_NEAR(flat.y(), warp.dot(drawn), 1e-15);
      EXPECT_NEAR(flat.x(), weft.dot(drawn), 1e-15);
    }
  }
}

TEST(BuildCloth, NamesTheSizeOfAPatternInTheWrongUnit) {
  Pattern pattern;
  pattern.panels = {square_panel("a", 7.0), square_panel("b", 7.0)};
  const Cloth cloth = build_cloth(scene_of(pattern, 0.1));
  ASSERT_EQ(cloth.warnings.size(), 1U);
  EXPECT_THAT(cloth.warnings[0], testing::HasSubstr("implausible_size: "));
  EXPECT_THAT(cloth.warnings[0], testing::HasSubstr("7 m tall"));
}

}  // namespace
}  // namespace toile
