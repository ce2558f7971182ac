#include "engine/solve/pin_motion.h"

#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"
#include "engine/solve/assemble.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

PinMoved quarter_turn() {
  PinMoved motion;
  motion.pivot = Vec3(1, 0, 0);
  motion.key_frames = {{1.0, Vec3::Zero(), Vec3::Zero()}, {3.0, Vec3(0, 0.4, 0), Vec3(0, 0, std::numbers::pi / 2)}};
  return motion;
}

TEST(PositionAt, AFixedVertexStays) {
  const HeldVertex held{0, Vec3(1, 2, 3), nullptr};
  EXPECT_EQ(position_at(held, 0), held.start);
  EXPECT_EQ(position_at(held, 7), held.start);
  const PinMoved nothing;
  EXPECT_EQ(position_at({0, Vec3(1, 2, 3), &nothing}, 7), held.start);
}

TEST(PositionAt, IsConstantBeforeTheFirstAndAfterTheLastKeyFrame) {
  const PinMoved motion = quarter_turn();
  const HeldVertex held{0, Vec3(2, 0, 0), &motion};
  EXPECT_LT((position_at(held, 0) - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((position_at(held, 1) - Vec3(2, 0, 0)).norm(), 1e-15);
  const Vec3 end(1, 1.4, 0);  // the arm of 1 m turned up, lifted by 0.4 m
  EXPECT_LT((position_at(held, 3) - end).norm(), 1e-15);
  EXPECT_LT((position_at(held, 30) - end).norm(), 1e-15);
}

TEST(PositionAt, TurnsAndMovesLinearlyBetweenKeyFrames) {
  const PinMoved motion = quarter_turn();
  const HeldVertex held{0, Vec3(2, 0, 0), &motion};
  const double angle = std::numbers::pi / 8;  // a quarter of the way
  EXPECT_LT((position_at(held, 1.5) - Vec3(1 + std::cos(angle), std::sin(angle) + 0.1, 0)).norm(), 1e-15);
  // No jump at a key frame.
  EXPECT_LT((position_at(held, 3 - 1e-9) - position_at(held, 3)).norm(), 1e-8);
  EXPECT_LT((position_at(held, 1 + 1e-9) - position_at(held, 1)).norm(), 1e-8);
}

TEST(PositionAt, AFirstKeyFrameAwayFromTheStartHoldsFromTheBeginning) {
  PinMoved motion;
  motion.key_frames = {{0.5, Vec3(0, 1, 0), Vec3::Zero()}};
  EXPECT_EQ(position_at({0, Vec3(2, 0, 0), &motion}, 0), Vec3(2, 1, 0));
}

TEST(SlidingVertices, AreThoseOfTheirPinsRenumberedAndNotHeld) {
  Scene scene = tube_scene();
  PinAttached sliding;
  sliding.slides = true;
  Garment& garment = scene.garments[0];
  garment.pins = {{PinEdge{0, 2}, sliding}, {PinVertices{{3}}, sliding}};
  const Cloth apart = build_cloth(scene);
  const CountingMonitor monitor;
  const BodyField body = make_body_field(*scene.body, 0.03);
  const Assembly assembly = assemble(scene, apart, {&body, nullptr}, [](const AssemblyState&) { return true; });
  ASSERT_TRUE(assembly.open_seams.empty());
  const auto found = sliding_vertices(scene, assembly.cloth);
  EXPECT_EQ(found.size(), pinned_vertices(garment.pins[0], 0, apart).size() + 1);
  for (const SlidingVertex& s : found) EXPECT_EQ(s.friction, scene.body->friction);
  EXPECT_TRUE(held_vertices(scene, assembly.cloth, assembly.attached, found).empty());
  EXPECT_FALSE(held_vertices(scene, assembly.cloth, assembly.attached).empty());
  std::get<PinAttached>(garment.pins[0].hold).friction = 0.7;
  EXPECT_EQ(sliding_vertices(scene, assembly.cloth).back().friction, 0.7);
}

TEST(SlidingVertices, RubAsTheirPairOfMaterialsDoes) {
  Scene scene = tube_scene();
  PinAttached sliding;
  sliding.slides = true;
  scene.garments[0].pins = {{PinEdge{0, 2}, sliding}};
  scene.friction_pairs = {{scene.garments[0].fabric.name, "", 0.05}};
  for (const SlidingVertex& s : sliding_vertices(scene, build_cloth(scene))) EXPECT_EQ(s.friction, 0.05);
}

/// Boxes and nearest points are asked of where the scene put the cloth, not of where sewing has brought it.
TEST(PinnedVertices, AreTheSameBeforeAndAfterSewing) {
  const Scene scene = tube_scene();
  Cloth cloth = build_cloth(scene);
  const Pin front{PinBox{Vec3(-1, 0.0499, 0), Vec3(1, 1, 1)}, PinFixed{}},
      one{PinNearest{Vec3(0.01, 0.05, 0.2)}, PinFixed{}};
  const std::vector<int> before = pinned_vertices(front, 0, cloth);
  const int nearest = pinned_vertices(one, 0, cloth).at(0);
  ASSERT_EQ(before.size(), 13u);  // the front's upper edge
  const std::vector<int> old_to_new = merge_seams(cloth);
  for (Vec3& x : cloth.x) x += Vec3(0.3, -2, -0.4);
  std::vector<int> after;
  for (const int v : before) after.push_back(old_to_new[v]);
  std::sort(after.begin(), after.end());
  EXPECT_EQ(pinned_vertices(front, 0, cloth), after);
  EXPECT_EQ(pinned_vertices(one, 0, cloth), std::vector<int>{old_to_new[nearest]});
}

TEST(LastKeyFrame, IsTheLatestOfAll) {
  PinMoved early, late = quarter_turn();
  early.key_frames = {{0.5, Vec3::Zero(), Vec3::Zero()}};
  EXPECT_EQ(last_key_frame({}), 0);
  EXPECT_EQ(last_key_frame({{0, Vec3::Zero(), nullptr}}), 0);
  EXPECT_EQ(last_key_frame({{0, Vec3::Zero(), &late}, {1, Vec3::Zero(), &early}}), 3);
}

class HeldVertices : public ::testing::Test {
 protected:
  HeldVertices() {
    scene.garments = {square_garment(0.2, 0.05, 0), square_garment(0.2, 0.05, 1)};
    cloth = build_cloth(scene);
  }
  std::vector<int> held_by(const Pin& pin, std::size_t garment = 1) {
    scene.garments[garment].pins = {pin};
    std::vector<int> vertices;
    for (const HeldVertex& h : held_vertices(scene, cloth, {})) vertices.push_back(h.vertex);
    return vertices;
  }
  Scene scene;
  Cloth cloth;
};

TEST_F(HeldVertices, AnEdgeIsAllVerticesAlongIt) {
  const std::vector<int> held = held_by({PinEdge{0, 2}, PinFixed{}});
  ASSERT_EQ(held.size(), 5u);  // 0.2 m in pieces of 0.05 m
  for (int v : held) {
    EXPECT_EQ(cloth.vertex_garment[v], 1);
    EXPECT_NEAR(cloth.x[v].z(), -0.1, 1e-12);
  }
}

TEST_F(HeldVertices, ALabelIsAllItsEdges) {
  auto& panel = std::get<Pattern>(scene.garments[1].shape).panels[0];
  panel.edges[1].label = panel.edges[3].label = "side";
  cloth = build_cloth(scene);
  const std::vector<int> held = held_by({PinLabel{"side"}, PinFixed{}});
  ASSERT_EQ(held.size(), 10u);
  for (int v : held) EXPECT_NEAR(std::abs(cloth.x[v].x()), 0.1, 1e-12);
}

TEST_F(HeldVertices, ABoxIsWhatLiesInItOfThatGarment) {
  const std::vector<int> held = held_by({PinBox{Vec3(-1, -1, -1), Vec3(1, 2, 0)}, PinFixed{}}, 0);
  std::size_t expected = 0;
  for (std::size_t v = 0; v < cloth.x.size(); ++v) expected += cloth.vertex_garment[v] == 0 && cloth.x[v].z() <= 0;
  EXPECT_EQ(held.size(), expected);
  EXPECT_GT(expected, 5u);
}

TEST_F(HeldVertices, TheNearestIsOneVertex) {
  const std::vector<int> held = held_by({PinNearest{Vec3(0.09, 0.2, 0.11)}, PinFixed{}});
  ASSERT_EQ(held.size(), 1u);
  EXPECT_LT((cloth.x[held[0]] - Vec3(0.1, 1, 0.1)).norm(), 1e-9);
}

TEST_F(HeldVertices, VerticesCountFromTheGarmentsFirst) {
  const int first = static_cast<int>(std::find(cloth.vertex_garment.begin(), cloth.vertex_garment.end(), 1) -
                                     cloth.vertex_garment.begin());
  EXPECT_EQ(held_by({PinVertices{{3, 1, 3}}, PinFixed{}}), (std::vector<int>{first + 1, first + 3}));
}

TEST_F(HeldVertices, TheFirstPinOfAVertexCounts) {
  PinMoved motion = quarter_turn();
  scene.garments[1].pins = {{PinEdge{0, 2}, motion}, {PinEdge{0, 1}, PinFixed{}}};
  const std::vector<HeldVertex> held = held_vertices(scene, cloth, {});
  EXPECT_EQ(held.size(), 9u);  // the corner once
  EXPECT_EQ(std::count_if(held.begin(), held.end(), [](const HeldVertex& h) { return h.motion != nullptr; }), 5);
  EXPECT_TRUE(std::is_sorted(held.begin(), held.end(),
                             [](const HeldVertex& a, const HeldVertex& b) { return a.vertex < b.vertex; }));
}

TEST_F(HeldVertices, AttachedVerticesAreHeldWhereTheyAre) {
  const std::vector<HeldVertex> held = held_vertices(scene, cloth, {4, 2});
  ASSERT_EQ(held.size(), 2u);
  EXPECT_EQ(held[0].vertex, 2);
  EXPECT_EQ(held[0].start, cloth.x[2]);
  EXPECT_EQ(held[0].motion, nullptr);
}

TEST_F(HeldVertices, APinThatSelectsNothingIsRefused) {
  scene.garments[1].pins = {{PinEdge{0, 2}, PinFixed{}}, {PinBox{Vec3(5, 5, 5), Vec3(6, 6, 6)}, PinFixed{}}};
  try {
    held_vertices(scene, cloth, {});
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "pin_selects_nothing");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/1/pins/1");
  }
}

TEST_F(HeldVertices, AVertexThatIsNotThereIsRefused) {
  scene.garments[1].pins = {{PinVertices{{100000}}, PinFixed{}}};
  EXPECT_THROW(held_vertices(scene, cloth, {}), InputError);
}

}  // namespace
}  // namespace toile
