#include "engine/geometry/distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace toile {
namespace {

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1);
  return {place(random), place(random), place(random)};
}

double sampled_point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, int n) {
  double best = INFINITY;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const double v = double(i) / n, w = double(j) / n;
      best = std::min(best, (p - (1 - v - w) * a - v * b - w * c).squaredNorm());
    }
  }
  return best;
}

TEST(PointTriangle, NeverFartherThanAnySampleAndConsistent) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(random), a = random_point(random), b = random_point(random), c = random_point(random);
    const PointTriangle r = point_triangle(p, a, b, c);
    EXPECT_NEAR(r.weights.sum(), 1, 1e-14);
    EXPECT_GE(r.weights.minCoeff(), 0);
    const Vec3 closest = r.weights[0] * a + r.weights[1] * b + r.weights[2] * c;
    EXPECT_NEAR((p - closest).squaredNorm(), r.squared_distance, 1e-13);
    const double sampled = sampled_point_triangle(p, a, b, c, 60);
    EXPECT_LE(r.squared_distance, sampled + 1e-14);
    EXPECT_NEAR(std::sqrt(r.squared_distance), std::sqrt(sampled), 0.03);
  }
}

TEST(PointTriangle, ClosestPointIsTheCornerTheEdgeOrTheFace) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(point_triangle({-1, -1, 0}, a, b, c).weights, Vec3(1, 0, 0));
  EXPECT_EQ(point_triangle({0.5, -1, 0}, a, b, c).weights, Vec3(0.5, 0.5, 0));
  EXPECT_DOUBLE_EQ(point_triangle({0.25, 0.25, 2}, a, b, c).squared_distance, 4);
  for (double d : {0.0, 1e-12, 1e-4, 1 - 1e-4, 1.0}) {
    EXPECT_NEAR(point_triangle({0.2, 0.2, d}, a, b, c).squared_distance, d * d, 1e-15 * d * d);
  }
}

TEST(PointTriangle, DegenerateTrianglesGiveTheirEdges) {
  const Vec3 p(0.3, 1, 0), a(0, 0, 0), b(1, 0, 0);
  EXPECT_DOUBLE_EQ(point_triangle(p, a, b, 0.5 * (a + b)).squared_distance, 1);
  EXPECT_DOUBLE_EQ(point_triangle(p, a, a, a).squared_distance, p.squaredNorm());
  EXPECT_NEAR(point_triangle(p, a, b, Vec3(0.5, 1e-14, 0)).squared_distance, 1, 1e-12);
  EXPECT_NEAR(point_triangle(p, a, b, Vec3(0.5, 1e-9, 0)).squared_distance, 1, 1e-8);
}

TEST(PointSegment, ClampsToTheEndsAndTakesPoints) {
  const Vec3 a(0, 0, 0), b(2, 0, 0);
  EXPECT_DOUBLE_EQ(point_segment({0.5, 1, 0}, a, b).t, 0.25);
  EXPECT_DOUBLE_EQ(point_segment({-1, 0, 0}, a, b).squared_distance, 1);
  EXPECT_DOUBLE_EQ(point_segment({5, 0, 0}, a, b).t, 1);
  EXPECT_DOUBLE_EQ(point_segment({0, 3, 0}, a, a).squared_distance, 9);
}

TEST(SegmentSegment, NeverFartherThanAnySampleAndConsistent) {
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec3 a = random_point(random), b = random_point(random), c = random_point(random), d = random_point(random);
    const SegmentSegment r = segment_segment(a, b, c, d);
    EXPECT_NEAR((a + r.s * (b - a) - c - r.t * (d - c)).squaredNorm(), r.squared_distance, 1e-13);
    double sampled = INFINITY;
    for (int j = 0; j <= 60; ++j) {
      for (int k = 0; k <= 60; ++k) {
        sampled = std::min(sampled, (a + j / 60.0 * (b - a) - c - k / 60.0 * (d - c)).squaredNorm());
      }
    }
    EXPECT_LE(r.squared_distance, sampled + 1e-14);
    EXPECT_NEAR(std::sqrt(r.squared_distance), std::sqrt(sampled), 0.03);
  }
}

TEST(SegmentSegment, ParallelOverlapGivesItsMiddle) {
  const SegmentSegment r = segment_segment({0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {2, 1, 0});
  EXPECT_DOUBLE_EQ(r.s, 0.75);
  EXPECT_DOUBLE_EQ(r.squared_distance, 1);
  const SegmentSegment reversed = segment_segment({0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {0.5, 1, 0});
  EXPECT_DOUBLE_EQ(reversed.s, 0.75);
  EXPECT_DOUBLE_EQ(reversed.squared_distance, 1);
}

TEST(SegmentSegment, NearlyParallelStaysExact) {
  for (double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4}) {
    const SegmentSegment r = segment_segment({0, 0, 0}, {1, 0, 0}, {0, 1 - tilt, tilt}, {1, 1 + tilt, -tilt});
    EXPECT_NEAR(std::sqrt(r.squared_distance), std::hypot(1 - tilt, tilt), 2e-12) << tilt;
    EXPECT_GE(std::min(r.s, r.t), 0);
    EXPECT_LE(std::max(r.s, r.t), 1);
  }
}

TEST(SegmentSegment, ParallelButApartGivesTheEnds) {
  const SegmentSegment r = segment_segment({0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {4, 1, 0});
  EXPECT_EQ(r.s, 1);
  EXPECT_EQ(r.t, 0);
  EXPECT_DOUBLE_EQ(r.squared_distance, 5);
}

TEST(SegmentSegment, CrossingAndDegenerate) {
  EXPECT_NEAR(segment_segment({-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}).squared_distance, 0, 1e-30);
  EXPECT_DOUBLE_EQ(segment_segment({0, 0, 0}, {0, 0, 0}, {0, 2, 0}, {0, 2, 0}).squared_distance, 4);
  EXPECT_DOUBLE_EQ(segment_segment({0.5, 3, 0}, {0.5, 3, 0}, {0, 0, 0}, {1, 0, 0}).squared_distance, 9);
}

}  // namespace
}  // namespace toile
