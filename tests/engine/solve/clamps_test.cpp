#include "engine/solve/clamps.h"

#include "engine/mesh/build_cloth.h"
#include "engine/monitor.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <set>

namespace toile {
namespace {

using namespace test;

/// A rectangle of 0.1 by 0.06 m in the x–y plane.
Scene sheet_scene(Pin pin) {
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("sheet", 0.1, 0.06)}, {}}, 0.01)};
  pin.clamp = true;
  scene.garments[0].pins = {pin};
  return scene;
}

TEST(Clamps, APanelsEdgeIsHeldByMirroredPoints) {
  const Scene scene = sheet_scene({PinEdge{0, 0}, PinFixed{}});
  Cloth cloth = build_cloth(scene);
  const std::size_t vertices = cloth.x.size();
  const std::vector<HeldVertex> points = add_clamps(cloth, held_vertices(scene, cloth, {}));
  ASSERT_EQ(points.size(), 10u);
  ASSERT_EQ(cloth.clamps.size(), 10u);
  EXPECT_EQ(cloth.x.size(), vertices + 10);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ClampedEdge& clamp = cloth.clamps[k];
    const Vec3 tip = cloth.x[cloth.triangles[clamp.triangle][clamp.corner]], point = cloth.x[clamp.tip];
    EXPECT_EQ(point, points[k].start);
    EXPECT_NEAR(point.y(), -tip.y(), 1e-12);
    EXPECT_NEAR(point.z(), 0, 1e-12);
  }
}

TEST(Clamps, RowsHoldByTheirTriangles) {
  const Scene scene = sheet_scene({PinBox{Vec3(-1, -1, -1), Vec3(1, 0.015, 1)}, PinFixed{}});
  Cloth cloth = build_cloth(scene);
  const std::size_t vertices = cloth.x.size();
  const std::vector<HeldVertex> held = held_vertices(scene, cloth, {});
  EXPECT_TRUE(add_clamps(cloth, held).empty());
  EXPECT_EQ(cloth.x.size(), vertices);
  std::set<int> held_set;
  for (const HeldVertex& h : held) held_set.insert(h.vertex);
  EXPECT_GE(cloth.clamps.size(), 8u);
  for (const ClampedEdge& clamp : cloth.clamps) {
    EXPECT_TRUE(held_set.contains(clamp.tip));
    EXPECT_FALSE(held_set.contains(cloth.triangles[clamp.triangle][clamp.corner]));
  }
}

TEST(Clamps, WithoutTheOptionThereAreNone) {
  Scene scene = sheet_scene({PinEdge{0, 0}, PinFixed{}});
  scene.garments[0].pins[0].clamp = false;
  Cloth cloth = build_cloth(scene);
  EXPECT_TRUE(add_clamps(cloth, held_vertices(scene, cloth, {})).empty());
  EXPECT_TRUE(cloth.clamps.empty());
}

TEST(Clamps, FollowTheirPin) {
  // A sheet that stands on its lower edge, stiff and without weight, turns with the clamp by a right angle.
  PinMoved turn;
  turn.key_frames = {{0, Vec3::Zero(), Vec3::Zero()}, {0.5, Vec3::Zero(), Vec3(std::numbers::pi / 2, 0, 0)}};
  Scene scene = sheet_scene({PinEdge{0, 0}, turn});
  scene.garments[0].fabric.bending_stiffness = {1e-3, 1e-3, 1e-3};
  Cloth cloth = build_cloth(scene);
  const std::size_t vertices = cloth.x.size();
  SimulationScene simulated;
  simulated.held = held_vertices(scene, cloth, {});
  simulated.options.gravity = false;
  simulated.options.max_time_step = 5e-3;
  const Simulation result = simulate(cloth, simulated, [](const SimulationState&) { return true; });
  EXPECT_EQ(result.stop_reason, "at_rest");
  ASSERT_EQ(cloth.x.size(), vertices);
  EXPECT_EQ(result.net_force.size(), vertices);
  EXPECT_EQ(result.mass.size(), vertices);
  for (const LabelledVertices& label : cloth.labels)
    if (label.label == "sheet/2")
      for (int v : label.vertices) {
        EXPECT_NEAR(cloth.x[v].y(), 0, 1e-3);
        EXPECT_NEAR(cloth.x[v].z(), 0.06, 1e-3);
      }
}

}  // namespace
}  // namespace toile
