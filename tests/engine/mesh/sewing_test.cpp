#include "engine/mesh/sewing.h"

#include <gtest/gtest.h>

#include <set>

namespace toile::test {
namespace {

/// A row of `count` squares of two triangles each, unit edges; vertices (i, 0) are 2 i, (i, 1) are 2 i + 1.
Cloth strip(int count) {
  Cloth cloth;
  for (int i = 0; i <= count; ++i)
    for (int j = 0; j < 2; ++j) cloth.x.emplace_back(i, j, 0);
  for (int i = 0; i < count; ++i) {
    const int a = 2 * i;
    for (const Triangle& t : {Triangle{a, a + 2, a + 1}, Triangle{a + 2, a + 3, a + 1}}) {
      cloth.triangles.push_back(t);
      std::array<Vec2, 3> flat;
      for (int k = 0; k < 3; ++k) flat[k] = cloth.x[t[k]].head<2>();
      cloth.flat.push_back(flat);
      cloth.triangle_panel.push_back(0);
    }
  }
  cloth.vertex_garment.assign(cloth.x.size(), 0);
  cloth.panels = {{0, "strip", "", 0, 1.0}};
  cloth.seam_names = {"seam"};
  return cloth;
}

TEST(MergeSeams, JoinedVerticesMeetInTheirMeanAndKeepTheirFlatPositions) {
  Cloth cloth = strip(4);
  cloth.seam_pairs = {{0, 8, 0}, {1, 9, 0}};
  const std::vector<int> renumbered = merge_seams(cloth);
  EXPECT_EQ(cloth.x.size(), 8u);
  EXPECT_EQ(renumbered[0], renumbered[8]);
  EXPECT_EQ(cloth.x[renumbered[0]], Vec3(2, 0, 0));
  EXPECT_EQ(cloth.triangles.size(), 8u);
  EXPECT_EQ(cloth.flat[0][0], Vec2(0, 0));
  EXPECT_TRUE(cloth.seam_pairs.empty());
  EXPECT_TRUE(cloth.warnings.empty());
}

TEST(MergeSeams, OfSeamsThatAreOpenTheClosedPairsCanBeMergedAlone) {
  Cloth cloth = strip(4);
  cloth.x[8] = cloth.x[0];
  cloth.seam_pairs = {{0, 8, 0}, {1, 9, 0}};
  const std::vector<int> renumbered = merge_closed_seams(cloth, 1e-9);
  EXPECT_EQ(cloth.x.size(), 9u);
  EXPECT_EQ(renumbered[0], renumbered[8]);
  ASSERT_EQ(cloth.seam_pairs.size(), 1u);
  EXPECT_EQ(cloth.seam_pairs[0].a, renumbered[1]);
  EXPECT_EQ(cloth.seam_pairs[0].b, renumbered[9]);
  EXPECT_NE(renumbered[1], renumbered[9]);
}

TEST(MergeSeams, TriangleWhoseCornersBecomeOneIsDroppedWithAWarning) {
  Cloth cloth = strip(3);
  cloth.seam_pairs = {{0, 2, 0}};
  merge_seams(cloth);
  EXPECT_EQ(cloth.triangles.size(), 5u);
  ASSERT_EQ(cloth.warnings.size(), 1u);
  EXPECT_EQ(cloth.warnings[0].rfind("collapsed_triangles: 1", 0), 0u);
}

TEST(MergeSeams, TwoTrianglesAtTheTipOfAPleatAreDropped) {
  // The tip 0 has the triangles (0, 1, 3) and (0, 3, 2); its neighbours 1 and 2 along the outline are sewn together.
  Cloth cloth;
  cloth.x = {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {-1, -1, 0}, {1, -1, 0}};
  cloth.triangles = {{0, 1, 3}, {0, 3, 2}, {1, 4, 3}, {2, 3, 5}};
  for (const Triangle& t : cloth.triangles) {
    std::array<Vec2, 3> flat;
    for (int k = 0; k < 3; ++k) flat[k] = cloth.x[t[k]].head<2>();
    cloth.flat.push_back(flat);
    cloth.triangle_panel.push_back(0);
  }
  cloth.vertex_garment.assign(6, 0);
  cloth.panels = {{0, "pleat", "", 0, 1.0}};
  cloth.seam_names = {"pleat"};
  cloth.seam_pairs = {{1, 2, 0}};
  cloth.labels = {{0, "waist", {1, 0, 2}}};
  const std::vector<int> renumbered = merge_seams(cloth);
  EXPECT_EQ(cloth.triangles.size(), 2u);
  EXPECT_EQ(renumbered[0], -1);  // no triangle is left to give it mass
  EXPECT_EQ(cloth.x.size(), 4u);
  EXPECT_EQ(cloth.labels[0].vertices, std::vector<int>{renumbered[1]});
  for (const Triangle& t : cloth.triangles)
    for (int v : t) {
      EXPECT_GE(v, 0);
      EXPECT_LT(v, 4);
    }
  ASSERT_EQ(cloth.warnings.size(), 1u);
}

}  // namespace
}  // namespace toile::test
