#include "engine/mesh/topology.h"

#include <gmock/gmock.h>

namespace toile {
namespace {

using testing::ElementsAre;

TEST(Topology, HingeIsTheSameWhicheverWayTheSecondTriangleRuns) {
  for (const Triangle& second : {Triangle{1, 0, 3}, Triangle{0, 1, 3}, Triangle{3, 1, 0}, Triangle{3, 0, 1}}) {
    const std::vector<Hinge> found = hinges({{0, 1, 2}, second});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].v0, 0);
    EXPECT_EQ(found[0].v1, 1);
    EXPECT_EQ(found[0].v2, 2);
    EXPECT_EQ(found[0].v3, 3);
    EXPECT_EQ(found[0].triangle_a, 0);
    EXPECT_EQ(found[0].triangle_b, 1);
  }
  const std::vector<Hinge> turned = hinges({{1, 0, 2}, {0, 1, 3}});
  EXPECT_EQ(turned[0].v0, 1) << "v0 to v1 is the way triangle_a runs";
}

TEST(Topology, EdgesStarsAndNonManifoldEdges) {
  const std::vector<Triangle> fan = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const std::vector<MeshEdge> edges = mesh_edges(fan);
  ASSERT_EQ(edges.size(), 7U);
  EXPECT_EQ(edges[0].triangle_count, 3);
  EXPECT_EQ(edges[1].triangle_b, -1);
  EXPECT_EQ(non_manifold_edges(fan).size(), 1U);
  EXPECT_TRUE(hinges(fan).empty());
  const VertexTriangles around = vertex_triangles(fan, 6);
  EXPECT_THAT(around.first, ElementsAre(0, 3, 6, 7, 8, 9, 9));
  EXPECT_THAT(around.triangles, ElementsAre(0, 1, 2, 0, 1, 2, 0, 1, 2));
  EXPECT_LE(boundary_loops(fan).size(), 2U) << "ends even where the boundary is no loop";
}

TEST(Topology, LoopsComponentsAndEulerOfKnownSurfaces) {
  const std::vector<Triangle> tetrahedron = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  EXPECT_EQ(euler_characteristic(tetrahedron), 2);
  EXPECT_TRUE(boundary_loops(tetrahedron).empty());
  EXPECT_EQ(hinges(tetrahedron).size(), 6U);

  // A band of six quads, closed: two boundary loops of six.
  std::vector<Triangle> band;
  for (int i = 0; i < 6; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % 6);
    band.push_back({a, b, b + 1});
    band.push_back({a, b + 1, a + 1});
  }
  EXPECT_EQ(euler_characteristic(band), 0);
  const auto loops = boundary_loops(band);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_THAT(loops[0], ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_EQ(loops[1].size(), 6U);

  std::vector<Triangle> two = tetrahedron;
  two.push_back({7, 8, 9});
  EXPECT_THAT(connected_components(two), ElementsAre(0, 0, 0, 0, 1));
  // Two triangles that meet in a vertex only are two components and two loops.
  EXPECT_THAT(connected_components({{0, 1, 2}, {2, 3, 4}}), ElementsAre(0, 1));
  EXPECT_EQ(boundary_loops({{0, 1, 2}, {2, 3, 4}}).size(), 2U);
}

}  // namespace
}  // namespace toile
