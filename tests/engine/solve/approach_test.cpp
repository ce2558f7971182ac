#include "engine/solve/approach.h"

#include "engine/mesh/sewing.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

constexpr double kApproachNear = 0.03, kApproachEdge = 0.02;

struct Approached {
  explicit Approached(const Pattern& pattern) : body(make_body_field(cylinder_body(), kApproachEdge)) {
    Scene scene;
    scene.garments = {garment_of(pattern, kApproachEdge)};
    cloth = build_cloth(scene);
    before = cloth.x;
    held.assign(cloth.x.size(), 0);
    panel = panel_of_vertices(cloth);
  }
  void run() {
    approach(cloth, 0, make_collision_mesh(cloth, 0, {{2, false}}),
             std::vector<const BodyField*>(cloth.x.size(), &body), held);
  }
  Vec3 move_of(int p) const {
    for (std::size_t v = 0; v < before.size(); ++v)
      if (panel[v] == p) return cloth.x[v] - before[v];
    return Vec3::Zero();
  }
  /// Every panel has moved as a whole.
  void expect_rigid() const {
    for (std::size_t v = 0; v < before.size(); ++v)
      EXPECT_LT((cloth.x[v] - before[v] - move_of(panel[v])).norm(), 1e-12);
  }
  double nearest(int p) const {
    double d = 1;
    for (std::size_t v = 0; v < before.size(); ++v)
      if (panel[v] == p) d = std::min(d, body.distance(cloth.x[v]));
    return d;
  }
  BodyField body;
  Cloth cloth;
  Positions before;
  std::vector<char> held;
  std::vector<int> panel;
};

TEST(Approach, PanelsComeNearTheBodyAlongTheirNormals) {
  Approached tube(tube_pattern(0.36, 0.15, 0.4, -0.1));
  tube.run();
  tube.expect_rigid();
  EXPECT_LT((tube.move_of(0) + Vec3(0, 0, 0.27)).norm(), 0.25 * kApproachEdge);
  EXPECT_LT((tube.move_of(1) - Vec3(0, 0, 0.27)).norm(), 0.25 * kApproachEdge);
  for (int p : {0, 1}) EXPECT_GE(tube.nearest(p), kApproachNear - 1e-9);
}

TEST(Approach, NeighboursInOnePlaneComeTogether) {
  // The front is cut in two along its middle, where both halves lie edge to edge.
  Pattern pattern;
  for (double side : {-0.09, 0.09}) {
    Panel half = around_axis(rectangle_panel(side < 0 ? "left" : "right", 0.18, 0.15), 0, 0.4, -0.1);
    half.translation.x() = side;
    pattern.panels.push_back(half);
  }
  pattern.panels.push_back(around_axis(rectangle_panel("back", 0.36, 0.15), std::numbers::pi, 0.4, -0.1));
  pattern.stitches = {{{0, 1}, {1, 3}, false}, {{1, 1}, {2, 3}, false}, {{0, 3}, {2, 1}, false}};
  Approached front(pattern);
  front.run();
  front.expect_rigid();
  EXPECT_LT(front.move_of(0).z(), -0.26);
  EXPECT_LT((front.move_of(0) - front.move_of(1)).norm(), 1e-9);
}

TEST(Approach, HeldPanelsAndThoseThatAreNearStay) {
  Approached tube(tube_pattern(0.36, 0.15, 0.4, -0.1));
  for (std::size_t v = 0; v < tube.held.size(); ++v)
    if (tube.panel[v] == 0) {
      tube.held[v] = 1;
      break;
    }
  tube.run();
  EXPECT_EQ(tube.move_of(0), Vec3(Vec3::Zero()));
  EXPECT_GT(tube.move_of(1).z(), 0.26);
  Approached near(tube_pattern(0.36, 0.15, 0.12, -0.1));
  near.run();
  EXPECT_EQ(near.cloth.x, near.before);
}

TEST(Approach, PanelsStopBeforeOtherCloth) {
  // A third panel, sewn to nothing, stands between the front and the body.
  Pattern pattern = tube_pattern(0.36, 0.15, 0.4, -0.1);
  pattern.panels.push_back(around_axis(rectangle_panel("between", 0.2, 0.1), 0, 0.3, -0.08));
  Approached tube(pattern);
  tube.run();
  EXPECT_EQ(tube.move_of(2), Vec3(Vec3::Zero()));
  EXPECT_LT(tube.move_of(0).z(), -0.08);
  EXPECT_GT(tube.move_of(0).z(), -0.1);
  EXPECT_EQ(self_intersections(tube.cloth.x, tube.cloth.triangles).size(), 0u);
}

}  // namespace
}  // namespace toile
