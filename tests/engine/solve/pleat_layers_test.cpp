#include "engine/solve/pleat_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace toile::test {
namespace {

/// Triangles beside each other in the plane about (0, 0), each turned a little from the one before, all at height 0.
FoldedPanel stack(int layers) {
  FoldedPanel panel;
  for (int l = 0; l < layers; ++l) {
    panel.triangles.push_back({3 * l, 3 * l + 1, 3 * l + 2});
    for (int k = 0; k < 3; ++k) {
      const double angle = 0.3 * l + 2 * M_PI / 3 * k;
      panel.plane.emplace_back(std::cos(angle), std::sin(angle));
      panel.height.push_back(0);
      panel.joined.push_back(static_cast<int>(panel.joined.size()));
    }
  }
  return panel;
}

double layer_by_triangle(const Triangle& t, const Vec3&) { return t[0] / 3; }

double height_at_middle(const FoldedPanel& panel, int layer) {
  return (panel.height[3 * layer] + panel.height[3 * layer + 1] + panel.height[3 * layer + 2]) / 3;
}

TEST(PleatLayers, LowerLayersComeToLieAboveByTheSpacing) {
  FoldedPanel panel = stack(4);
  lay_in_order(panel, layer_by_triangle, 0.1);
  for (int l = 0; l + 1 < 4; ++l) EXPECT_GT(height_at_middle(panel, l), height_at_middle(panel, l + 1) + 0.04) << l;
}

TEST(PleatLayers, WhatIsInOrderStays) {
  FoldedPanel panel = stack(3);
  for (int v = 0; v < 9; ++v) panel.height[v] = -0.11 * (v / 3);
  const std::vector<double> before = panel.height;
  lay_in_order(panel, layer_by_triangle, 0.1);
  EXPECT_EQ(panel.height, before);
}

TEST(PleatLayers, JoinedVerticesKeepOneHeightAndTheOrderHoldsAroundThem) {
  FoldedPanel panel = stack(2);
  panel.plane[3] = panel.plane[0];
  panel.joined[3] = 0;
  panel.height = {0, -0.1, -0.1, 0, 0.1, 0.1};  // the upper one lies beneath
  lay_in_order(panel, layer_by_triangle, 0.1);
  EXPECT_EQ(panel.height[3], panel.height[0]);
  EXPECT_GT(height_at_middle(panel, 0), height_at_middle(panel, 1));
}

TEST(PleatLayers, TrianglesThatJoiningFlattensAreLeftOut) {
  FoldedPanel panel = stack(3);
  panel.joined[1] = 0;                                            // the first becomes an edge
  panel.joined[6] = 3, panel.joined[7] = 4, panel.joined[8] = 5;  // the last lies on the second
  EXPECT_TRUE(kept_triangles(panel).empty());
  panel.joined[6] = 6;
  EXPECT_EQ(kept_triangles(panel).size(), 2u);
}

}  // namespace
}  // namespace toile::test
