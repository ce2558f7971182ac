#include "engine/contact/proximity.h"

#include "tests/engine/contact/sheet.h"

#include <gtest/gtest.h>

#include <random>

namespace toile {
namespace {

using test::add_sheet;

Vec3 point_of(const Contact& c, const Positions& x) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < c.count; ++k) p += c.weights[k] * x[c.nodes[k]];
  return p;
}

/// Does segment ab pass through triangle pqr? Signs of volumes; independent of the code under test.
bool pierces(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q, const Vec3& r) {
  const auto volume = [](const Vec3& o, const Vec3& u, const Vec3& v, const Vec3& w) {
    return (u - o).dot((v - o).cross(w - o));
  };
  if ((volume(a, p, q, r) > 0) == (volume(b, p, q, r) > 0)) return false;
  const bool s1 = volume(a, b, p, q) > 0, s2 = volume(a, b, q, r) > 0, s3 = volume(a, b, r, p) > 0;
  return s1 == s2 && s2 == s3;
}

long crossings(const CollisionMesh& mesh, const Positions& x) {
  long count = 0;
  for (const auto& [a, b] : mesh.edges)
    for (const Triangle& t : mesh.triangles) {
      if (t[0] == a || t[1] == a || t[2] == a || t[0] == b || t[1] == b || t[2] == b) continue;
      count += pierces(x[a], x[b], x[t[0]], x[t[1]], x[t[2]]);
    }
  return count;
}

TEST(Proximity, AFlatSheetDoesNotTouchItself) {
  Cloth cloth;
  add_sheet(cloth, 20, 20, 0.015, 0);
  Proximity proximity(make_collision_mesh(cloth, 0), 0.006);
  proximity.update(cloth.x);
  EXPECT_TRUE(proximity.contacts().empty());
}

TEST(Proximity, LayersAtADistanceTouchWithThatGapAndAnUprightNormal) {
  Cloth cloth;
  add_sheet(cloth, 10, 10, 0.015, 0);
  add_sheet(cloth, 10, 10, 0.015, 0.0012, 0.004);
  Proximity proximity(make_collision_mesh(cloth, 0.002), 0.006);
  proximity.update(cloth.x);
  ASSERT_FALSE(proximity.contacts().empty());
  for (const Contact& c : proximity.contacts()) {
    EXPECT_NEAR(std::abs(c.normal.y()), 1, 1e-9);
    EXPECT_NEAR(c.normal.dot(point_of(c, cloth.x)) - c.offset, 0.0012, 1e-12);
    EXPECT_DOUBLE_EQ(c.distance, 0.002);
    EXPECT_NEAR(c.weights[0] + c.weights[1] + c.weights[2] + c.weights[3], 0, 1e-12);
  }
  EXPECT_NEAR(proximity.smallest_distance(), 0.0012, 1e-12);
}

TEST(Proximity, SeamPartnersAreOneVertex) {
  Cloth cloth;
  add_sheet(cloth, 2, 3, 0.015, 0);
  add_sheet(cloth, 2, 3, 0.015, 0.001);
  for (int v = 0; v < 6; ++v) cloth.seam_pairs.push_back({v, v + 6, 0});
  cloth.seam_names = {"all"};
  Proximity proximity(make_collision_mesh(cloth, 0.002), 0.006);
  proximity.update(cloth.x);
  for (const Contact& c : proximity.contacts())
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) EXPECT_FALSE(c.weights[i] * c.weights[j] < 0 && c.nodes[i] % 6 == c.nodes[j] % 6);
}

// The guarantee that the whole engine rests on: moves of any kind, limited by the bounds, cross nothing.
TEST(Proximity, LimitedMovesNeverCross) {
  Cloth cloth;
  add_sheet(cloth, 8, 8, 0.015, 0);
  add_sheet(cloth, 8, 8, 0.015, 0.003, 0.005);
  add_sheet(cloth, 8, 8, 0.015, 0.006, 0.002);
  Proximity proximity(make_collision_mesh(cloth, 0), 0.008);
  Positions x = cloth.x;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-0.01, 0.01);
  long limited = 0, unlimited_crossings = 0;
  for (int round = 0; round < 60; ++round) {
    proximity.update(x);
    Positions wanted = x;
    for (Vec3& p : wanted) p += Vec3(move(random), move(random), move(random));
    if (round == 0) unlimited_crossings = crossings(proximity.mesh(), wanted);
    limited += limit_displacements(x, proximity.displacement_bounds(), wanted);
    x = wanted;
    ASSERT_EQ(crossings(proximity.mesh(), x), 0) << "round " << round;
    ASSERT_GT(proximity.smallest_distance(), 0);
  }
  EXPECT_GT(unlimited_crossings, 0);  // the moves would have crossed
  EXPECT_GT(limited, 1000);
}

TEST(Proximity, MovesShortenedByPlanesNeverCross) {
  Cloth cloth;
  add_sheet(cloth, 8, 8, 0.015, 0);
  add_sheet(cloth, 8, 8, 0.015, 0.003, 0.005);
  add_sheet(cloth, 8, 8, 0.015, 0.006, 0.002);
  Proximity proximity(make_collision_mesh(cloth, 0), 0.008);
  Positions x = cloth.x;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> move(-0.01, 0.01);
  long shortened = 0;
  for (int round = 0; round < 60; ++round) {
    proximity.update(x);
    Positions wanted = x;
    for (Vec3& p : wanted) p += Vec3(move(random), move(random), move(random));
    shortened += proximity.limit_moves(x, wanted);
    x = wanted;
    ASSERT_EQ(crossings(proximity.mesh(), x), 0) << "round " << round;
    ASSERT_GT(proximity.smallest_distance(), 0);
  }
  EXPECT_GT(shortened, 1000);
}

TEST(Proximity, PressedLayersStillSlideAndPart) {
  Cloth cloth;
  add_sheet(cloth, 4, 4, 0.015, 0);
  add_sheet(cloth, 4, 4, 0.015, 1e-7, 0.004);
  Proximity proximity(make_collision_mesh(cloth, 0), 0.008);
  proximity.update(cloth.x);
  Positions to = cloth.x;
  for (std::size_t v = 16; v < to.size(); ++v) to[v] += Vec3(2e-4, 0, 1e-4);
  Positions slid = to, parted = cloth.x, pressed = cloth.x;
  EXPECT_EQ(proximity.limit_moves(cloth.x, slid), 0);
  for (std::size_t v = 16; v < to.size(); ++v) {
    parted[v].y() += 1e-3;
    pressed[v].y() -= 1e-3;
  }
  EXPECT_EQ(proximity.limit_moves(cloth.x, parted), 0);
  EXPECT_EQ(proximity.limit_moves(cloth.x, pressed), 16);
  for (std::size_t v = 16; v < to.size(); ++v) EXPECT_GT(pressed[v].y(), 0);
  EXPECT_GT(limit_displacements(cloth.x, proximity.displacement_bounds(), to), 0);  // the bounds forbid it
}

TEST(Proximity, WhatTouchesExactlyStaysWhereItIs) {
  Cloth cloth;
  add_sheet(cloth, 4, 4, 0.015, 0);
  add_sheet(cloth, 4, 4, 0.015, 0, 0.004);
  Proximity proximity(make_collision_mesh(cloth, 0), 0.008);
  proximity.update(cloth.x);
  Positions to = cloth.x;
  const std::size_t inner = 16 + 5;  // lies in a triangle of the other sheet
  to[inner].y() -= 1e-3;
  EXPECT_EQ(proximity.limit_moves(cloth.x, to), 1);
  EXPECT_EQ(to[inner], cloth.x[inner]);
}

TEST(Proximity, KeepsKeysFromStepToStep) {
  Cloth cloth;
  add_sheet(cloth, 6, 6, 0.015, 0);
  add_sheet(cloth, 6, 6, 0.015, 0.0012, 0.004);
  Proximity proximity(make_collision_mesh(cloth, 0.002), 0.006);
  proximity.update(cloth.x);
  const std::vector<Contact> before = proximity.contacts();
  Positions x = cloth.x;
  for (Vec3& p : x) p += Vec3(1e-5, 2e-5, -1e-5);
  proximity.update(x);
  ASSERT_EQ(proximity.contacts().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(proximity.contacts()[i].key, before[i].key);
}

}  // namespace
}  // namespace toile
