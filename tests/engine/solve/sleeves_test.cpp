#include "engine/solve/sleeves.h"

#include <gtest/gtest.h>

#include "engine/quality/intersections.h"
#include "tests/engine/solve/scenes.h"

namespace toile::test {
namespace {

constexpr double kRadius = 0.05, kHeight = 0.09;

/// An arm along x, and above it a flat panel `width` wide, sewn to itself along both long sides.
struct Arm {
  BodyField body;
  Cloth panel;
  BodyFields fields() const { return {&body, nullptr, nullptr}; }
};

Arm arm_under_panel(double width) {
  Body body;
  body.shape = CapsuleBody{{-0.5, 0, 0}, {0.5, 0, 0}, kRadius};
  const int rows = static_cast<int>(width / (0.01 * std::sqrt(3.0) / 2)) / 2 * 2;
  Arm arm{make_body_field(body, 0.01), equilateral_sheet(12, rows, 0.01, suiting(), [&](const Vec2& uv) {
            return Vec3(uv.x() - 0.06, kHeight, uv.y() - 0.5 * width);
          })};
  double last = -1;
  for (const Vec3& p : arm.panel.x) last = std::max(last, p.z());
  std::vector<int> first_side, second_side;
  for (std::size_t v = 0; v < arm.panel.x.size(); ++v) {
    if (arm.panel.x[v].z() < -0.5 * width + 1e-9) first_side.push_back(static_cast<int>(v));
    if (arm.panel.x[v].z() > last - 1e-9) second_side.push_back(static_cast<int>(v));
  }
  EXPECT_EQ(first_side.size(), second_side.size());
  for (std::size_t k = 0; k < first_side.size(); ++k)
    arm.panel.seam_pairs.push_back({first_side[k], second_side[k], 0});
  arm.panel.seam_names = {"under the arm"};
  return arm;
}

TEST(RolledTube, GoesRoundTheArmWithItsSidesBeneath) {
  Arm arm = arm_under_panel(0.36);
  const Positions flat = arm.panel.x;
  std::vector<std::string> part = {""};
  roll_tubes(arm.panel, part, arm.fields());
  EXPECT_NE(part[0], "");
  for (const Vec3& p : arm.panel.x) EXPECT_GT(arm.body.distance(p), 2e-3);
  for (const SeamPair& pair : arm.panel.seam_pairs) {
    EXPECT_LT(arm.panel.x[pair.a].y(), 0);
    EXPECT_LT(arm.panel.x[pair.b].y(), 0);
    EXPECT_LT((arm.panel.x[pair.a] - arm.panel.x[pair.b]).norm(), 0.1);
  }
  for (const Triangle& t : arm.panel.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      EXPECT_NEAR((arm.panel.x[a] - arm.panel.x[b]).norm() / (flat[a] - flat[b]).norm(), 1, 0.01);  // not stretched
    }
  EXPECT_TRUE(self_intersections(arm.panel.x, arm.panel.triangles).empty());
}

TEST(RolledTube, TightSleeveReachesAsFarRoundAsItIsWide) {
  Arm arm = arm_under_panel(0.25);
  std::vector<std::string> part = {""};
  roll_tubes(arm.panel, part, arm.fields());
  for (const Vec3& p : arm.panel.x) EXPECT_GT(arm.body.distance(p), 2e-3);
  for (const SeamPair& pair : arm.panel.seam_pairs) EXPECT_LT(arm.panel.x[pair.a].y(), 0.01);
}

TEST(RolledTube, WithoutALimbBehindThePanelStaysFlat) {
  Arm arm = arm_under_panel(0.3);
  for (Vec3& p : arm.panel.x) p.y() += 1;
  const Positions before = arm.panel.x;
  std::vector<std::string> part = {""};
  roll_tubes(arm.panel, part, arm.fields());
  EXPECT_EQ(arm.panel.x, before);
  EXPECT_EQ(part[0], "");
}

TEST(RolledTube, DartIsNoTube) {
  Arm arm = arm_under_panel(0.3);
  arm.panel.seam_pairs.clear();
  for (int k = 0; k < 4; ++k) arm.panel.seam_pairs.push_back({k, 9 - k, 0});
  const Positions before = arm.panel.x;
  std::vector<std::string> part = {""};
  roll_tubes(arm.panel, part, arm.fields());
  EXPECT_EQ(arm.panel.x, before);
}

}  // namespace
}  // namespace toile::test
