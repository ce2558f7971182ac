#include "engine/mesh/build_cloth.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/topology.h"
#include "engine/scene/problem.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace toile {
namespace {

using namespace test;

TEST(Creases, WithoutSeamsAndFoldsThereAreNone) { EXPECT_TRUE(build_cloth(tube_scene()).creases.empty()); }

TEST(Creases, EverySeamEdgeHasTheGarmentsFactor) {
  Scene scene = tube_scene();
  scene.garments[0].seam_bending.stiffness_factor = 3;
  Cloth cloth = build_cloth(scene);
  merge_seams(cloth);
  std::set<std::pair<int, int>> creased;
  for (const Crease& c : cloth.creases) {
    EXPECT_EQ(c.stiffness_factor, 3);
    EXPECT_EQ(c.rest_angle, 0);
    creased.insert(std::minmax(c.v0, c.v1));
  }
  // Both seams of 0.15 m in edges of 0.03 m, all of them inner edges of the sewn mesh.
  EXPECT_EQ(creased.size(), 10u);
  for (const MeshEdge& edge : mesh_edges(cloth.triangles))
    if (creased.contains({edge.v0, edge.v1})) {
      EXPECT_EQ(edge.triangle_count, 2);
    }
}

TEST(Creases, AFoldFollowsAPanelEdgeAndCountsBeforeTheSeam) {
  Scene scene = tube_scene();
  scene.garments[0].seam_bending.stiffness_factor = 3;
  scene.garments[0].folds = {{PinEdge{1, 1}, 0.5, 2}};
  Cloth cloth = build_cloth(scene);
  merge_seams(cloth);
  std::map<std::pair<int, int>, Crease> last;
  for (const Crease& c : cloth.creases) last[std::minmax(c.v0, c.v1)] = c;
  int folded = 0;
  for (const auto& [edge, c] : last) folded += c.rest_angle == 0.5 && c.stiffness_factor == 2;
  EXPECT_EQ(folded, 5);
  EXPECT_EQ(last.size(), 10u);
}

TEST(Creases, AFoldOffTheMeshIsRefused) {
  Scene scene;
  GarmentMesh shape;
  shape.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  shape.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  shape.mesh.corner_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}};
  Garment garment;
  garment.shape = shape;
  garment.folds = {{PinVertices{{0, 2}}, 1, 1}};
  scene.garments = {garment};
  ASSERT_EQ(build_cloth(scene).creases.size(), 1u);
  scene.garments[0].folds[0].select = PinVertices{{0, 2, 1, 3}};
  try {
    build_cloth(scene);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "fold_not_on_mesh");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/0/folds/0");
  }
}

}  // namespace
}  // namespace toile
