#include "engine/solve/position_based.h"

#include "engine/parallel/state_hash.h"
#include "engine/parallel/thread_limit.h"
#include "tests/engine/contact/sheet.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

constexpr double kEdge = 0.015;

PositionBased solver_of(const Cloth& cloth, const BodyField* body = nullptr) {
  return PositionBased(cloth, make_collision_mesh(cloth, 0), std::vector<const BodyField*>(cloth.x.size(), body));
}

double largest_edge_strain(const Cloth& cloth) {
  double worst = 0;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const double rest = (cloth.flat[t][(k + 1) % 3] - cloth.flat[t][k]).norm();
      const double now = (cloth.x[cloth.triangles[t][(k + 1) % 3]] - cloth.x[cloth.triangles[t][k]]).norm();
      worst = std::max(worst, std::abs(now / rest - 1));
    }
  return worst;
}

/// Two strips side by side, 60 mm apart, whose facing columns are to meet.
Cloth facing_strips(std::vector<SeamPull>& pulls, double lift = 0.004) {
  Cloth cloth;
  const int rows = 8, columns = 5;
  add_sheet(cloth, rows, columns, kEdge, 0);
  add_sheet(cloth, rows, columns, kEdge, lift, columns * kEdge + 0.06);
  for (int r = 0; r < rows; ++r) {
    const int a = r * columns + columns - 1, b = rows * columns + r * columns;
    pulls.push_back({a, b});
    cloth.seam_pairs.push_back({a, b, 0});
  }
  cloth.seam_names = {"seam"};
  return cloth;
}

TEST(PositionBased, WhatIsAtRestStays) {
  Cloth cloth;
  add_sheet(cloth, 8, 8, kEdge, 0);
  const Positions before = cloth.x;
  PositionBased solver = solver_of(cloth);
  for (int s = 0; s < 5; ++s) EXPECT_EQ(solver.step(cloth.x, {}), 0);
  EXPECT_LT(solver.largest_move(), 1e-12);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_LT((cloth.x[v] - before[v]).norm(), 1e-12);
}

TEST(PositionBased, PullsCloseASeamWithoutCrossingOrStretchingTheCloth) {
  std::vector<SeamPull> pulls;
  Cloth cloth = facing_strips(pulls);
  PositionBased solver = solver_of(cloth);
  solver.set_pulls(pulls);
  double gap = 1;
  int steps = 0;
  while (gap > 1e-4 && steps++ < 500) {
    gap = solver.step(cloth.x, {});
    ASSERT_TRUE(all_finite(cloth.x));
    if (steps % 10 == 0) {
      ASSERT_EQ(self_intersections(cloth.x, cloth.triangles).size(), 0u) << steps;
    }
  }
  EXPECT_LE(gap, 1e-4);
  double largest = 0;
  for (const SeamPull& pull : pulls) largest = std::max(largest, (cloth.x[pull.a] - cloth.x[pull.b]).norm());
  EXPECT_DOUBLE_EQ(gap, largest);
  PositionBasedOptions calm;
  calm.carry = 0.5;
  for (int s = 0; s < 100; ++s) solver.step(cloth.x, calm);
  EXPECT_LT(largest_edge_strain(cloth), 0.02);
}

TEST(PositionBased, HeldVerticesDoNotMoveAndTheOthersComeToThem) {
  std::vector<SeamPull> pulls;
  Cloth cloth = facing_strips(pulls);
  PositionBased solver = solver_of(cloth);
  solver.set_pulls(pulls);
  const Positions before = cloth.x;
  for (int v = 0; v < 40; ++v) solver.mobility[v] = 0;
  double gap = 1;
  for (int s = 0; s < 500 && gap > 1e-4; ++s) gap = solver.step(cloth.x, {});
  EXPECT_LE(gap, 1e-4);
  for (int v = 0; v < 40; ++v) EXPECT_EQ(cloth.x[v], before[v]);
}

TEST(PositionBased, VerticesThatKeepTheirHeightSlideSideways) {
  std::vector<SeamPull> pulls;
  Cloth cloth = facing_strips(pulls, 0);
  PositionBased solver = solver_of(cloth);
  solver.set_pulls(pulls);
  std::fill(solver.keep_height.begin(), solver.keep_height.end(), 1);
  const Positions before = cloth.x;
  for (int s = 0; s < 100; ++s) solver.step(cloth.x, {});
  double moved = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    ASSERT_NEAR(cloth.x[v].y(), before[v].y(), 1e-12);
    moved = std::max(moved, (cloth.x[v] - before[v]).norm());
  }
  EXPECT_GT(moved, 0.02);
}

TEST(PositionBased, NoVertexMovesFartherThanTwiceTheLimit) {
  std::vector<SeamPull> pulls;
  Cloth cloth = facing_strips(pulls);
  PositionBased solver = solver_of(cloth);
  solver.set_pulls(pulls);
  PositionBasedOptions options;
  options.max_move = 1e-3;
  options.closing = 0.1;
  for (int s = 0; s < 10; ++s) {
    const Positions before = cloth.x;
    solver.step(cloth.x, options);
    double largest = 0;
    for (std::size_t v = 0; v < before.size(); ++v) largest = std::max(largest, (cloth.x[v] - before[v]).norm());
    EXPECT_LE(largest, 2e-3 * (1 + 1e-9));
    EXPECT_NEAR(solver.largest_move(), largest, 1e-12);
  }
}

TEST(PositionBased, FallsOntoABallAndStaysOutOfIt) {
  const BodyField ball = make_body_field({SphereBody{Vec3(0.05, -0.07, 0.045), 0.06}, 0.3}, kEdge);
  Cloth cloth;
  add_sheet(cloth, 10, 10, kEdge, 0);
  PositionBased solver = solver_of(cloth, &ball);
  PositionBasedOptions options;
  options.fall = {0, -1e-4, 0};
  options.body_offset = 3e-3;
  double lowest = 1;
  for (int s = 0; s < 250; ++s) {
    solver.step(cloth.x, options);
    for (const Vec3& p : cloth.x) lowest = std::min(lowest, ball.distance(p));
    ASSERT_TRUE(all_finite(cloth.x));
  }
  EXPECT_GT(lowest, 2e-3);
  double rim = 1;
  for (const Vec3& p : cloth.x) rim = std::min(rim, p.y());
  EXPECT_LT(rim, -0.02) << "the sheet did not fall";
  EXPECT_EQ(self_intersections(cloth.x, cloth.triangles).size(), 0u);
}

TEST(PositionBased, FoldsOntoItselfWithoutCrossing) {
  Cloth cloth;
  add_sheet(cloth, 8, 12, kEdge, 0);
  PositionBased solver = solver_of(cloth);
  std::vector<SeamPull> pulls;
  for (int r = 0; r < 8; ++r) pulls.push_back({r * 12, r * 12 + 11});
  for (int r = 0; r < 8; ++r) cloth.x[r * 12] += Vec3(0, 3e-3, 0);  // says which way to fold
  solver.set_pulls(pulls);
  for (int s = 0; s < 200; ++s) {
    solver.step(cloth.x, {});
    if (s % 10 == 9) {
      ASSERT_EQ(self_intersections(cloth.x, cloth.triangles).size(), 0u) << s;
    }
  }
}

TEST(PositionBased, SameBytesOnAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    const ThreadLimit limit(threads);
    const BodyField ball = make_body_field({SphereBody{Vec3(0.15, -0.09, 0.15), 0.08}, 0.3}, kEdge);
    Cloth cloth;
    add_sheet(cloth, 24, 20, kEdge, 0);
    PositionBased solver = solver_of(cloth, &ball);
    PositionBasedOptions options;
    options.fall = {0, -2e-4, 0};
    for (int s = 0; s < 40; ++s) solver.step(cloth.x, options);
    return sha256_hex(cloth.x);
  };
  const std::string one = hash(1);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(4));
}

}  // namespace
}  // namespace toile
