#include "engine/solve/edge_selection.h"

#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"
#include "engine/solve/trimmings.h"
#include "tests/engine/solve/scenes.h"

#include <gmock/gmock.h>

#include <numeric>

namespace toile {
namespace {

using namespace test;

double total(const std::vector<FlatEdge>& edges) {
  return std::accumulate(edges.begin(), edges.end(), 0.0, [](double sum, const FlatEdge& e) { return sum + e.length; });
}

Scene labelled_tube() {
  Scene scene = tube_scene();
  Pattern& pattern = std::get<Pattern>(scene.garments[0].shape);
  pattern.panels[0].edges[2].label = pattern.panels[1].edges[2].label = "waist";
  pattern.panels[0].edges[0].label = "hem";
  return scene;
}

Cloth sewn_from(const Scene& scene) {
  Cloth cloth = build_cloth(scene);
  merge_seams(cloth);
  return cloth;
}

TEST(EdgeSelection, ALabelMeansTheEdgesAlongItOnEveryPanel) {
  const Scene scene = labelled_tube();
  const Cloth cloth = sewn_from(scene);
  const std::vector<FlatEdge> waist = selected_edges(PinLabel{"waist"}, scene.garments[0], 0, cloth);
  EXPECT_EQ(waist.size(), 24u);  // 0.36 m at 30 mm, twice
  EXPECT_NEAR(total(waist), 0.72, 1e-12);
  EXPECT_EQ(connected_chains(waist).size(), 1u);  // sewing made them one ring
  EXPECT_EQ(connected_chains(selected_edges(PinLabel{"waist"}, scene.garments[0], 0, build_cloth(scene))).size(), 2u);
}

TEST(EdgeSelection, APanelEdgeABoxAndAListOfVerticesAgree) {
  const Scene scene = labelled_tube();
  const Cloth cloth = sewn_from(scene);
  const Garment& garment = scene.garments[0];
  const std::vector<FlatEdge> edge = selected_edges(PinEdge{0, 0}, garment, 0, cloth);
  EXPECT_EQ(edge.size(), 12u);
  EXPECT_NEAR(total(edge), 0.36, 1e-12);
  const std::vector<FlatEdge> hem = selected_edges(PinBox{Vec3(-1, -0.101, -1), Vec3(1, -0.099, 1)}, garment, 0, cloth);
  EXPECT_NEAR(total(hem), 0.72, 1e-12);
  PinVertices listed;
  for (const FlatEdge& e : edge) listed.vertices.push_back(e.vertices[0]);
  listed.vertices.push_back(edge.back().vertices[1]);
  EXPECT_NEAR(total(selected_edges(listed, garment, 0, cloth)), 0.36, 1e-12);
  EXPECT_TRUE(selected_edges(PinNearest{Vec3::Zero()}, garment, 0, cloth).empty());
}

TEST(EdgeSelection, NamesAreThoseOfTheirOwnGarment) {
  Scene scene = labelled_tube();
  scene.garments.push_back(scene.garments[0]);
  const Cloth cloth = sewn_from(scene);
  for (const FlatEdge& e : selected_edges(PinLabel{"waist"}, scene.garments[1], 1, cloth))
    for (int v : e.vertices) EXPECT_EQ(cloth.vertex_garment[v], 1);
}

TEST(Trimmings, TakeLengthsFromTheFlatPattern) {
  Scene scene = labelled_tube();
  scene.garments[0].elastics = {{PinLabel{"waist"}, 0.8, 25, 0.01}};
  scene.garments[0].drawcords = {{PinLabel{"hem"}, 0.3, 500, 0.01}};
  const Trimmings trimmings = make_trimmings(scene, sewn_from(scene));
  ASSERT_EQ(trimmings.elastics.size(), 24u);
  double relaxed = 0;
  for (const ElasticStencil& s : trimmings.elastics) relaxed += s.rest_length;
  EXPECT_NEAR(relaxed, 0.8 * 0.72, 1e-12);
  EXPECT_EQ(trimmings.elastics[0].stiffness, 25);
  ASSERT_EQ(trimmings.drawcords.size(), 1u);
  EXPECT_EQ(trimmings.drawcords[0].segments.size(), 12u);
  EXPECT_EQ(trimmings.drawcords[0].rest_length, 0.3);
}

TEST(Trimmings, NamesTheOneThatSelectsNothing) {
  Scene scene = labelled_tube();
  scene.garments[0].drawcords = {{PinBox{Vec3(5, 5, 5), Vec3(6, 6, 6)}, 0.3, 500, 0.01}};
  try {
    make_trimmings(scene, sewn_from(scene));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "selects_no_edge");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/0/drawcords/0");
  }
}

}  // namespace
}  // namespace toile
