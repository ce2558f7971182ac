#include "engine/mesh/panel_outline.h"

#include "tests/engine/mesh/real_patterns.h"

#include <cmath>

namespace toile {
namespace {

class RealOutline : public RealPattern {};

TEST_P(RealOutline, HasTheAreasLengthsCornersAndNormalsOfAnIndependentImporter) {
  const Pattern pattern = real_pattern(GetParam());
  const nlohmann::json expected = expected_values(GetParam());
  ASSERT_EQ(pattern.panels.size(), expected["panels"].size());
  double total = 0;
  for (const Panel& panel : pattern.panels) {
    const nlohmann::json& known = expected["panels"][panel.name];
    const double area = signed_area(panel);
    total += std::abs(area);
    // Theirs is of a fine polygon: 1.4e-6 short on a full circle.
    EXPECT_NEAR(std::abs(area), known["area_m2"].get<double>(), 2e-6 * std::abs(area)) << panel.name;
    EXPECT_EQ(area > 0 ? "ccw" : "cw", known["loop"].get<std::string>()) << panel.name;
    const Vec3 normal = outward_normal(panel);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(normal[axis], known["outward_normal"][static_cast<std::size_t>(axis)].get<double>(), 1e-5);
    }
    ASSERT_EQ(panel.edges.size(), known["edge_lengths_m"].size());
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
      const double length = known["edge_lengths_m"][e];
      EXPECT_NEAR(edge_length(panel, static_cast<int>(e)), length, 1e-7 + 1e-6 * length) << panel.name << "/" << e;
      const Vec3 corner = to_world(panel, panel.vertices[static_cast<std::size_t>(panel.edges[e].start)]);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(corner[axis], known["corners_3d_m"][e][static_cast<std::size_t>(axis)].get<double>(), 1e-6);
      }
    }
  }
  EXPECT_NEAR(total, expected["total_area_m2"].get<double>(), 2e-6 * total);
}

TEST_P(RealOutline, HasTheSeamLengthsOfAnIndependentImporter) {
  const Pattern pattern = real_pattern(GetParam());
  const nlohmann::json expected = expected_values(GetParam());
  ASSERT_EQ(pattern.stitches.size(), expected["seams"].size());
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const nlohmann::json& seam = expected["seams"][s];
    const PatternStitch& stitch = pattern.stitches[s];
    EXPECT_EQ(stitch.right_wrong, seam["right_wrong"].get<bool>());
    EXPECT_EQ(stitch.a.panel, panel_named(pattern, seam["a"][0]));
    EXPECT_EQ(stitch.a.edge, seam["a"][1].get<int>());
    const auto length = [&](const PatternStitch::Side& side) {
      return edge_length(pattern.panels[static_cast<std::size_t>(side.panel)], side.edge);
    };
    EXPECT_NEAR(length(stitch.a), seam["len_a"].get<double>(), 1e-6);
    EXPECT_NEAR(length(stitch.b), seam["len_b"].get<double>(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealOutline, testing::ValuesIn(kRealPatterns));

/// Two arcs between (-1, 0) and (1, 0): a disc where the radius is one.
Panel lens(double radius, bool large_arc, bool right) {
  Panel panel;
  panel.name = "lens";
  panel.vertices = {{-1, 0}, {1, 0}};
  panel.edges = {{0, 1, ArcEdge{radius, large_arc, right}, ""}, {1, 0, ArcEdge{radius, large_arc, right}, ""}};
  return panel;
}

TEST(PanelOutline, ArcsOfADiscHaveItsAreaAndCircumference) {
  const Panel disc = lens(1.0, false, true);
  EXPECT_NEAR(signed_area(disc), M_PI, 1e-12);
  EXPECT_NEAR(edge_length(disc, 0), M_PI, 1e-12);
  EXPECT_NEAR(signed_area(lens(1.0, false, false)), -M_PI, 1e-12);
  EXPECT_NEAR(edge_length(lens(0.3, false, true), 0), M_PI, 1e-12) << "a radius below half the chord is half the chord";
}

TEST(PanelOutline, LargeArcTakesTheLongWay) {
  const Panel panel = lens(2.0, true, true);
  EXPECT_NEAR(edge_length(panel, 0), 2.0 * (2 * M_PI - M_PI / 3), 1e-12);
  // Right: bulges below the chord from left to right.
  EXPECT_NEAR(edge_point(panel, 0, 0.5).y(), -(2.0 + std::sqrt(3.0)), 1e-12);
  EXPECT_GT(signed_area(panel), 0);
}

TEST(PanelOutline, SamplesAreUniformInArcLengthEvenWhereTheParameterIsNot) {
  Panel panel = square_panel("p", 1.0);
  panel.edges[0].curve = CubicEdge{{0.02, -0.6}, {0.9, 0.3}};
  const int fine = 20000, coarse = 20;
  const std::vector<Vec2> points = sample_edge(panel, 0, coarse);
  ASSERT_EQ(points.size(), 21U);
  EXPECT_EQ(points.front(), panel.vertices[0]);
  EXPECT_EQ(points.back(), panel.vertices[1]);
  // Walk the curve finely and note the length at which it is nearest to each sample.
  double walked = 0;
  std::vector<double> nearest(points.size(), 1e9), at(points.size(), 0);
  Vec2 previous = points.front();
  for (int i = 0; i <= fine; ++i) {
    const Vec2 p = edge_point(panel, 0, static_cast<double>(i) / fine);
    walked += (p - previous).norm();
    previous = p;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if ((p - points[k]).norm() < nearest[k]) {
        nearest[k] = (p - points[k]).norm();
        at[k] = walked;
      }
    }
  }
  EXPECT_NEAR(edge_length(panel, 0), walked, 1e-6);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NEAR(at[k], walked * static_cast<double>(k) / coarse, 1e-4);
}

TEST(PanelOutline, QuadraticIsItsCubic) {
  Panel quadratic = square_panel("q", 1.0), cubic = quadratic;
  quadratic.edges[2].curve = QuadraticEdge{{0.3, 0.4}};
  cubic.edges[2].curve = CubicEdge{{0.2, 0.8 / 3}, {0.2 + 1.0 / 3, 0.8 / 3}};
  EXPECT_NEAR(edge_length(quadratic, 2), edge_length(cubic, 2), 1e-12);
  EXPECT_NEAR(signed_area(quadratic), signed_area(cubic), 1e-12);
  // Area under a quadratic of height 0.4 over a unit base is two thirds of the control triangle's 0.2; it lies left of
  // the edge, inside a counter-clockwise loop.
  EXPECT_NEAR(signed_area(quadratic), 1 - 2.0 / 3 * 0.2, 1e-12);
}

}  // namespace
}  // namespace toile
