#include "engine/solve/fairing.h"

#include <gtest/gtest.h>

#include "engine/quality/intersections.h"
#include "tests/engine/solve/sheets.h"

namespace toile::test {
namespace {

int nearest(const Positions& x, const Vec3& p) {
  int best = 0;
  for (std::size_t v = 0; v < x.size(); ++v)
    if ((x[v] - p).norm() < (x[best] - p).norm()) best = static_cast<int>(v);
  return best;
}

TEST(Fairing, PatchAroundAVertexGrowsByEdges) {
  const Cloth sheet = equilateral_sheet(10, 10, 0.01, suiting());
  const int n = static_cast<int>(sheet.x.size());
  const int middle = nearest(sheet.x, {0.05, 0, 0.043});
  EXPECT_EQ(vertices_around({middle}, sheet.triangles, n, 0).size(), 1u);
  EXPECT_EQ(vertices_around({middle}, sheet.triangles, n, 1).size(), 7u);
  EXPECT_EQ(vertices_around({middle}, sheet.triangles, n, 2).size(), 19u);
}

TEST(Fairing, TwistedPatchInsideAFlatSheetLiesFlatAgain) {
  Cloth sheet = equilateral_sheet(12, 12, 0.01, suiting());
  const std::vector<int> patch =
      vertices_around({nearest(sheet.x, {0.06, 0, 0.05})}, sheet.triangles, static_cast<int>(sheet.x.size()), 2);
  const Vec3 center = sheet.x[nearest(sheet.x, {0.06, 0, 0.05})];
  for (int v : patch) sheet.x[v] = center - (sheet.x[v] - center) + Vec3(0, 1e-3 * v / 100, 0);  // turned by 180°
  ASSERT_FALSE(self_intersections(sheet.x, sheet.triangles).empty());
  ASSERT_TRUE(fair(sheet.x, sheet.triangles, patch));
  EXPECT_TRUE(self_intersections(sheet.x, sheet.triangles).empty());
  for (int v : patch) EXPECT_NEAR(sheet.x[v].y(), 0, 1e-9);
}

TEST(Fairing, EndOfASheetThatWasTurnedOverGoesOnAsTheRestOfIt) {
  const Cloth sheet = equilateral_sheet(12, 12, 0.01, suiting());
  Positions x = sheet.x;
  const std::vector<int> corner =
      vertices_around({0}, sheet.triangles, static_cast<int>(sheet.x.size()), 2);  // at the outline
  for (int v : corner) x[v] = {0.03 - x[v].x(), 0.004, x[v].z()};
  ASSERT_TRUE(fair(x, sheet.triangles, corner));
  for (int v : corner) EXPECT_NEAR((x[v] - sheet.x[v]).norm(), 0, 0.012);  // the corner is rounded
  EXPECT_TRUE(self_intersections(x, sheet.triangles).empty());
}

TEST(Fairing, WhatNothingHoldsStays) {
  Cloth sheet = equilateral_sheet(3, 3, 0.01, suiting());
  const Positions before = sheet.x;
  std::vector<int> all(sheet.x.size());
  for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  EXPECT_FALSE(fair(sheet.x, sheet.triangles, all));
  EXPECT_EQ(sheet.x, before);
}

}  // namespace
}  // namespace toile::test
