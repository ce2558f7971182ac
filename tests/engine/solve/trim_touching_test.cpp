// What trims are found to touch, and what is left alone.

#include "engine/solve/trim_touching.h"

#include "engine/geometry/rotation.h"
#include "engine/mesh/build_cloth.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <set>

namespace toile {
namespace {

using namespace test;

constexpr double kDiameter = 11.5e-3, kThickness = 2.5e-3;

RigidTrim disc_at(const Vec3& center) {
  RigidTrim trim;
  trim.body = disc_body(0.4e-3, kDiameter, kThickness);
  trim.shape = disc_shape(kDiameter, kThickness);
  trim.start.center = center;
  trim.start.orientation = rotation_by(Vec3(-0.5 * std::numbers::pi, 0, 0));  // its axis upright
  trim.friction = 0.3;
  return trim;
}

/// A sheet in the x–z plane whose triangles are wider than a button.
Cloth coarse_sheet() { return equilateral_sheet(6, 7, 0.02, suiting()); }

std::vector<RigidState> starts(const std::vector<RigidTrim>& trims) {
  std::vector<RigidState> states;
  for (const RigidTrim& trim : trims) states.push_back(trim.start);
  return states;
}

double depth(const TrimContact& c) { return c.contact.distance + c.contact.offset; }  // p is zero where detected

TEST(TrimTouching, AButtonInTheMiddleOfATriangleTouchesIt) {
  const Cloth sheet = coarse_sheet();
  const Triangle& t = sheet.triangles[40];
  const Vec3 middle = (sheet.x[t[0]] + sheet.x[t[1]] + sheet.x[t[2]]) / 3;
  const double gap = 0.5e-3;
  const std::vector<RigidTrim> trims = {disc_at(middle + (0.5 * kThickness + gap) * Vec3::UnitY())};
  const TrimTouching touching(sheet, trims, {});
  int pressing = 0;
  std::set<std::uint64_t> keys;
  for (const TrimContact& c : touching.detect(sheet.x, starts(trims))) {
    EXPECT_TRUE(keys.insert(c.contact.key).second);
    double sum = 0;
    Vec3 at = Vec3::Zero();
    for (int i = 0; i < c.contact.count; ++i) {
      sum += c.contact.weights[i];
      at += c.contact.weights[i] * sheet.x[c.contact.nodes[i]];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    if (depth(c) <= 0) continue;
    ++pressing;
    EXPECT_LT((at - middle).norm(), 0.5 * kDiameter + c.contact.distance);
    if ((at - middle).norm() > 0.5 * kDiameter) continue;
    EXPECT_LT((c.contact.normal + Vec3::UnitY()).norm(), 1e-9);  // away from the button
    EXPECT_NEAR(-c.contact.offset, gap, 1e-12);
  }
  EXPECT_GE(pressing, 8);  // no vertex is below it, but points of the triangle are
}

TEST(TrimTouching, WhatTheThreadHoldsIsLeftAloneAtRest) {
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("panel", 0.1, 0.1)}, {}}, 0.01)};
  Trim trim;
  trim.holes = {{"panel", Vec2(0.011, 0.052)}};
  scene.garments[0].trims = {trim};
  const Cloth cloth = build_cloth(scene);
  const Trimmings trimmings = make_trimmings(scene, cloth);
  const TrimTouching touching(cloth, trimmings.trims, {});
  const std::vector<TrimContact> contacts = touching.detect(cloth.x, starts(trimmings.trims));
  EXPECT_GT(contacts.size(), 10u);                                   // near, …
  for (const TrimContact& c : contacts) EXPECT_LE(depth(c), 1e-12);  // … and not pressed
}

TEST(TrimTouching, ListsWhatComesOnWithinTheMarginAndNothingFarther) {
  const Cloth sheet = coarse_sheet();
  for (const double height : {3e-3, 8e-3}) {
    const std::vector<RigidTrim> trims = {disc_at(Vec3(0.06, height + 0.5 * kThickness, 0.06))};
    EXPECT_EQ(TrimTouching(sheet, trims, {}).detect(sheet.x, starts(trims)).empty(), height > 6e-3);
  }
}

TEST(TrimTouching, ATrimWithoutShapeTouchesNothing) {
  const Cloth sheet = coarse_sheet();
  std::vector<RigidTrim> trims = {disc_at(Vec3(0.06, 1e-3, 0.06))};
  trims[0].shape = {};
  EXPECT_TRUE(TrimTouching(sheet, trims, {}).detect(sheet.x, starts(trims)).empty());
}

TEST(TrimTouching, AgainstTheBodyItsSurfaceIsAsked) {
  const Cloth sheet = equilateral_sheet(1, 1, 0.01, suiting(), [](const Vec2& uv) { return Vec3(uv.x(), 1, uv.y()); });
  Body body;
  body.shape = PlaneBody{Vec3::Zero(), Vec3::UnitY()};
  const BodyField plane = make_body_field(body, 0.01);
  TouchingOptions options;
  options.body = &plane;
  const double deep = 0.2e-3;
  const std::vector<RigidTrim> trims = {disc_at(Vec3(0.3, 0.5 * kThickness - deep, 0.1))};
  int pressing = 0;
  for (const TrimContact& c : TrimTouching(sheet, trims, options).detect(sheet.x, starts(trims))) {
    EXPECT_EQ(c.contact.count, 0);
    EXPECT_EQ(c.side, 1);
    EXPECT_LT((c.contact.normal - Vec3::UnitY()).norm(), 1e-12);
    const double gap = c.contact.normal.dot(c.contact.anchor) - c.contact.offset;
    if (gap < 0) {
      ++pressing;
      EXPECT_NEAR(gap, -deep, 1e-12);
    }
  }
  EXPECT_EQ(pressing, 25);  // the lower face: middle, ring and rim
}

TEST(TrimTouching, RemembersHowFarFrictionWasStretched) {
  const Cloth sheet = coarse_sheet();
  const std::vector<RigidTrim> trims = {disc_at(Vec3(0.06, 0.5 * kThickness + 0.5e-3, 0.06))};
  TrimTouching touching(sheet, trims, {});
  std::vector<RigidState> states = starts(trims);
  std::vector<TrimContact> contacts = touching.detect(sheet.x, states);
  for (const TrimContact& c : contacts) EXPECT_EQ(c.contact.anchor.norm(), 0);
  const Vec3 moved(2e-5, 0, 1e-5);
  states[0].center += moved;
  touching.remember(contacts, sheet.x, states);
  int found = 0;
  for (const TrimContact& c : touching.detect(sheet.x, states)) {
    if (depth(c) <= 0 || (c.contact.normal + Vec3::UnitY()).norm() > 1e-9) continue;
    ++found;
    EXPECT_LT((c.contact.anchor - moved).norm(), 1e-12);  // p is minus the trim's move
  }
  EXPECT_GE(found, 5);
}

}  // namespace
}  // namespace toile
