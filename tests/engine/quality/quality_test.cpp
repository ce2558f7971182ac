#include "engine/quality/distance_between.h"
#include "engine/quality/penetration.h"
#include "engine/quality/stretch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace toile {
namespace {

TEST(Stretch, RatiosOfAKnownDeformationWhateverTheWinding) {
  // Weft by 1.1, warp by 0.9, then turned in space.
  const Mat3 turn = Eigen::AngleAxisd(1.0, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto deformed = [&](const Vec2& u) { return Vec3(turn * Vec3(1.1 * u.x(), 0.9 * u.y(), 0)); };
  std::vector<std::array<Vec2, 3>> flat{{Vec2(0, 0), Vec2(0.3, 0.1), Vec2(0.1, 0.4)},
                                        {Vec2(0, 0), Vec2(0.1, 0.4), Vec2(0.3, 0.1)}};
  Positions x;
  for (const auto& corners : flat) {
    for (const Vec2& u : corners) x.push_back(deformed(u));
  }
  const TriangleStretch s = triangle_stretch(flat, {{0, 1, 2}, {3, 4, 5}}, x);
  for (int t = 0; t < 2; ++t) {
    EXPECT_NEAR(s.weft[t], 0.1, 1e-14);
    EXPECT_NEAR(s.warp[t], -0.1, 1e-14);
    EXPECT_NEAR(s.bias[t], std::sqrt((1.21 + 0.81) / 2) - 1, 1e-14);
    EXPECT_NEAR(s.area[t], 0.5 * (0.3 * 0.4 - 0.1 * 0.1), 1e-15);
  }
}

TEST(Stretch, ShearShowsOnTheBiasOnly) {
  const double gamma = 0.1;
  const TriangleStretch s = triangle_stretch({{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}}, {{0, 1, 2}},
                                             {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(std::sin(gamma), std::cos(gamma), 0)});
  EXPECT_NEAR(s.weft[0], 0, 1e-15);
  EXPECT_NEAR(s.warp[0], 0, 1e-15);
  EXPECT_NEAR(s.bias[0], std::sqrt(1 + std::sin(gamma)) - 1, 1e-14);
}

TEST(Stretch, TheSmallerPrincipalRatioWhateverItsDirection) {
  // 1.2 and 0.5 along directions at 30° to warp and weft.
  const Mat2 turn = Eigen::Rotation2Dd(0.5236).toRotationMatrix();
  const Mat2 f = turn * Vec2(1.2, 0.5).asDiagonal() * turn.transpose();
  const std::array<Vec2, 3> flat{Vec2(0, 0), Vec2(0.3, 0.1), Vec2(0.1, 0.4)};
  Positions x;
  for (const Vec2& u : flat) x.push_back({(f * u).x(), 0.7, (f * u).y()});
  EXPECT_NEAR(triangle_stretch({flat}, {{0, 1, 2}}, x).smallest[0], -0.5, 1e-14);
}

TEST(Stretch, StatisticsAreWeightedByArea) {
  std::vector<double> stretch(100), area(100, 1.0);
  for (int i = 0; i < 100; ++i) stretch[i] = 0.001 * i;
  StretchStatistics s = stretch_statistics(stretch, area);
  EXPECT_NEAR(s.mean, 0.0495, 1e-15);
  EXPECT_DOUBLE_EQ(s.p99, 0.098);
  EXPECT_DOUBLE_EQ(s.max, 0.099);
  EXPECT_DOUBLE_EQ(s.min, 0);
  EXPECT_DOUBLE_EQ(s.p01, 0);
  EXPECT_DOUBLE_EQ(s.median, 0.049);
  area[99] = 1000;
  s = stretch_statistics(stretch, area);
  EXPECT_DOUBLE_EQ(s.p99, 0.099);
  area[99] = 0;
  EXPECT_DOUBLE_EQ(stretch_statistics(stretch, area).max, 0.098);
  EXPECT_EQ(stretch_statistics({}, {}).max, 0);
}

TEST(Penetration, FindsTheDeepestPointBetweenVertices) {
  const BodyField ball = make_body_field(Body{SphereBody{Vec3::Zero(), 0.1}, 0.3}, 0.015);
  // A large triangle whose corners are all outside and whose plane cuts the ball 10 mm deep.
  const Positions x{Vec3(-0.5, -0.3, 0.09), Vec3(0.5, -0.3, 0.09), Vec3(0.0, 0.6, 0.09)};
  const Penetration found = deepest_penetration(ball, x, {{0, 1, 2}});
  EXPECT_EQ(found.triangle, 0);
  EXPECT_NEAR(found.depth, 0.01, 1e-12);
  EXPECT_NEAR((found.point - Vec3(0, 0, 0.09)).norm(), 0, 1e-12);
}

TEST(Penetration, FindsTheDeepestPointOfASliverToTheMicrometre) {
  const BodyField ball = make_body_field(Body{SphereBody{Vec3(0.0123, 0.0007, 0), 0.1}, 0.3}, 0.015);
  const Positions x{Vec3(-0.31, 0, 0.0968), Vec3(0.2, 0.0004, 0.0968), Vec3(0.21, 0.003, 0.0968)};
  const Penetration found = deepest_penetration(ball, x, {{0, 1, 2}});
  // The ball's middle is over the triangle's inside.
  EXPECT_NEAR(found.depth, 0.0032, 1e-6);
  EXPECT_LT((found.point - Vec3(0.0123, 0.0007, 0.0968)).norm(), 5e-4);
}

TEST(Penetration, NothingInsideIsZero) {
  const BodyField ball = make_body_field(Body{SphereBody{Vec3::Zero(), 0.1}, 0.3}, 0.015);
  const Positions x{Vec3(-0.5, -0.3, 0.101), Vec3(0.5, -0.3, 0.101), Vec3(0.0, 0.6, 0.101)};
  const Penetration found = deepest_penetration(ball, x, {{0, 1, 2}});
  EXPECT_EQ(found.triangle, -1);
  EXPECT_EQ(found.depth, 0);
}

TEST(DistanceBetween, ShiftedSquares) {
  const Positions a{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  Positions lifted = a, slid = a;
  for (Vec3& x : lifted) x.z() += 0.25;
  for (Vec3& x : slid) x.x() += 0.25;
  const std::vector<Triangle> t{{0, 1, 2}, {0, 2, 3}};
  EXPECT_DOUBLE_EQ(vertex_distance(a, lifted).mean, 0.25);
  EXPECT_DOUBLE_EQ(surface_distance(a, t, lifted, t).mean, 0.25);
  EXPECT_DOUBLE_EQ(surface_distance(a, t, lifted, t).max, 0.25);
  // Sliding in its own plane is a distance for vertices, and only at the rim for surfaces.
  EXPECT_DOUBLE_EQ(vertex_distance(a, slid).mean, 0.25);
  const DrapeDistance surface = surface_distance(a, t, slid, t);
  EXPECT_DOUBLE_EQ(surface.max, 0.25);
  EXPECT_LT(surface.mean, 0.1);
  EXPECT_EQ(surface_distance(a, t, a, t).max, 0);
}

TEST(DistanceBetween, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(vertex_distance({Vec3::Zero()}, {}), std::invalid_argument);
  EXPECT_THROW(surface_distance({Vec3::Zero()}, {}, {Vec3::Zero()}, {{0, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace toile
