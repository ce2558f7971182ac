#include "engine/mesh/panel_mesher.h"

#include "engine/mesh/build_cloth.h"
#include "engine/mesh/polygon.h"
#include "engine/mesh/topology.h"
#include "engine/scene/problem.h"
#include "tests/engine/mesh/real_patterns.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

namespace toile {
namespace {

constexpr double kDegree = M_PI / 180;

double area_of(const FlatMesh& mesh, const Triangle& t) {
  const Vec2 a = mesh.vertices[static_cast<std::size_t>(t[0])], b = mesh.vertices[static_cast<std::size_t>(t[1])];
  const Vec2 c = mesh.vertices[static_cast<std::size_t>(t[2])];
  return ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x())) / 2;
}

double angle_of(const FlatMesh& mesh, const Triangle& t) {
  return smallest_angle(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])],
                        mesh.vertices[static_cast<std::size_t>(t[2])]);
}

/// What every mesh must be: the outline kept and every segment of it an edge, positive triangles, one disc, the area.
void expect_sound(const FlatMesh& mesh, const std::vector<Vec2>& outline) {
  const int n = static_cast<int>(outline.size());
  ASSERT_GE(mesh.vertices.size(), outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i) ASSERT_EQ(mesh.vertices[i], outline[i]);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    ASSERT_GT(area_of(mesh, t), 0);
    area += area_of(mesh, t);
  }
  EXPECT_NEAR(area, std::abs(polygon_area(outline)), 1e-9 * area);
  std::set<std::pair<int, int>> boundary;
  for (const MeshEdge& edge : mesh_edges(mesh.triangles)) {
    ASSERT_LE(edge.triangle_count, 2);
    if (edge.triangle_count == 1) boundary.emplace(edge.v0, edge.v1);
  }
  EXPECT_EQ(boundary.size(), outline.size());
  for (int i = 0; i < n; ++i) EXPECT_TRUE(boundary.count(std::minmax(i, (i + 1) % n))) << "outline segment " << i;
  EXPECT_EQ(euler_characteristic(mesh.triangles), 1);
  EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size() + outline.size() + 2) << "a vertex is in no triangle";
}

std::vector<Vec2> sampled(const std::vector<Vec2>& corners, double h) {
  std::vector<Vec2> outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    const int n = std::max(1, static_cast<int>(std::ceil((b - a).norm() / h - 1e-9)));
    for (int k = 0; k < n; ++k) outline.push_back(a + (b - a) * k / n);
  }
  return outline;
}

std::string code_of(const std::vector<Vec2>& outline) {
  try {
    mesh_polygon(outline, 0.01, "/here");
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].pointer, "/here");
    return error.problems()[0].code;
  }
  return "none";
}

TEST(PanelMesher, RectangleIsNearlyEquilateral) {
  const double h = 0.01;
  const std::vector<Vec2> outline = sampled({{0, 0}, {0.4, 0}, {0.4, 0.6}, {0, 0.6}}, h);
  const FlatMesh mesh = mesh_polygon(outline, h);
  expect_sound(mesh, outline);
  double worst = M_PI, sum = 0;
  for (const Triangle& t : mesh.triangles) {
    worst = std::min(worst, angle_of(mesh, t));
    sum += angle_of(mesh, t);
  }
  EXPECT_GT(worst, 28 * kDegree);
  EXPECT_GT(sum / static_cast<double>(mesh.triangles.size()), 54 * kDegree);
  double length = 0;
  const std::vector<MeshEdge> edges = mesh_edges(mesh.triangles);
  for (const MeshEdge& edge : edges) {
    length +=
        (mesh.vertices[static_cast<std::size_t>(edge.v0)] - mesh.vertices[static_cast<std::size_t>(edge.v1)]).norm();
  }
  EXPECT_NEAR(length / static_cast<double>(edges.size()), h, 0.05 * h);
}

TEST(PanelMesher, ClockwiseOutlineKeepsItsPointsAndGivesCounterClockwiseTriangles) {
  std::vector<Vec2> outline = sampled({{0, 0}, {0.3, 0}, {0.2, 0.2}, {0.05, 0.25}}, 0.015);
  std::reverse(outline.begin(), outline.end());
  expect_sound(mesh_polygon(outline, 0.015), outline);
}

TEST(PanelMesher, AwkwardOutlines) {
  const double h = 0.015;
  const std::vector<std::pair<const char*, std::vector<Vec2>>> shapes = {
      {"triangle of three points", {{0, 0}, {0.005, 0}, {0, 0.005}}},
      {"quad smaller than h", {{0, 0}, {0.005, 0}, {0.006, 0.004}, {0, 0.004}}},
      {"waistband narrower than h", sampled({{0, 0}, {0.8, 0}, {0.8, 0.006}, {0, 0.006}}, h)},
      {"waistband as wide as h", sampled({{0, 0}, {0.8, 0}, {0.8, 0.015}, {0, 0.015}}, h)},
      {"narrow dart", sampled({{0, 0}, {0.14, 0}, {0.15, 0.12}, {0.152, 0}, {0.3, 0}, {0.3, 0.3}, {0, 0.3}}, h)},
      {"needle dart", sampled({{0, 0}, {0.15, 0}, {0.15, 0.2}, {0.1502, 0}, {0.3, 0}, {0.3, 0.3}, {0, 0.3}}, h)},
      {"edge of 0.7 mm", sampled({{0, 0}, {0.2, 0}, {0.2007, 0}, {0.25, 0.2}, {0, 0.2}}, h)},
      {"spike", sampled({{0, 0}, {0.5, 0.004}, {0, 0.2}}, h)},
      {"horseshoe",
       sampled({{0, 0}, {0.3, 0}, {0.3, 0.4}, {0.2, 0.4}, {0.2, 0.01}, {0.1, 0.01}, {0.1, 0.4}, {0, 0.4}}, h)},
      {"comb",
       sampled(
           {{0, 0}, {0.2, 0}, {0.2, 0.1}, {0.19, 0.02}, {0.15, 0.1}, {0.12, 0.015}, {0.1, 0.1}, {0.05, 0.01}, {0, 0.1}},
           h)},
      {"dense on one side",
       [] {
         std::vector<Vec2> outline = sampled({{0, 0}, {0.3, 0}}, 0.004);
         outline.resize(75);
         for (const Vec2& p : sampled({{0.3, 0}, {0.3, 0.2}, {0, 0.2}, {0, 0}}, 0.015)) outline.push_back(p);
         outline.resize(outline.size() - 20);
         return outline;
       }()},
  };
  for (const auto& [name, outline] : shapes) {
    SCOPED_TRACE(name);
    const FlatMesh mesh = mesh_polygon(outline, h);
    expect_sound(mesh, outline);
  }
}

TEST(PanelMesher, RandomStarsAreMeshedSoundly) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.02, 0.3);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vec2> corners;
    const int n = 5 + trial % 20;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n;
      corners.push_back(radius(random) * Vec2(std::cos(angle), std::sin(angle)));
    }
    SCOPED_TRACE(trial);
    const std::vector<Vec2> outline = sampled(corners, 0.02);
    expect_sound(mesh_polygon(outline, 0.02), outline);
  }
}

TEST(PanelMesher, RefusesWhatIsNoPanel) {
  EXPECT_EQ(code_of({{0, 0}, {1, 0}}), "panel_too_small");
  EXPECT_EQ(code_of({{0, 0}, {1, 0}, {2, 0}}), "zero_area_panel");
  EXPECT_EQ(code_of({{0, 0}, {1, 1}, {1, 0}, {0, 0.9}}), "self_crossing_panel");
  EXPECT_EQ(code_of({{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0, 1}}), "self_crossing_panel") << "touches its own edge";
  EXPECT_EQ(code_of({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.5}, {0.5, 0.9}, {0.5, 0.5}, {0, 1}}), "self_crossing_panel");
}

TEST(PanelMesher, SameInputSameMesh) {
  const std::vector<Vec2> outline = sampled({{0, 0}, {0.3, 0.05}, {0.25, 0.3}, {0.1, 0.2}}, 0.01);
  const FlatMesh a = mesh_polygon(outline, 0.01), b = mesh_polygon(outline, 0.01);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// How direction-dependent a hinge lattice is: the bending stiffness of a cylinder across `direction` is proportional
/// to Σ l² (n·d)⁴-like moments; on an equilateral lattice the fourth moment of edge directions is the same for every d.
TEST(PanelMesher, EdgeDirectionsAreIsotropicToFourthOrder) {
  const double h = 0.01;
  const std::vector<Vec2> outline = sampled({{0, 0}, {0.3, 0}, {0.32, 0.25}, {0.15, 0.35}, {-0.02, 0.2}}, h);
  const FlatMesh mesh = mesh_polygon(outline, h);
  double low = 1e9, high = 0;
  for (int k = 0; k < 12; ++k) {
    const Vec2 d(std::cos(k * M_PI / 12), std::sin(k * M_PI / 12));
    double moment = 0;
    for (const Hinge& hinge : hinges(mesh.triangles)) {
      const Vec2 edge =
          mesh.vertices[static_cast<std::size_t>(hinge.v1)] - mesh.vertices[static_cast<std::size_t>(hinge.v0)];
      const Vec2 normal = Vec2(-edge.y(), edge.x()).normalized();
      moment += edge.squaredNorm() * std::pow(normal.dot(d), 4);
    }
    low = std::min(low, moment);
    high = std::max(high, moment);
  }
  EXPECT_LT(high / low, 1.05);
}

TEST(PanelMesher, FiftyThousandVerticesInAFewSeconds) {
  const double h = 0.005;
  const std::vector<Vec2> outline = sampled({{0, 0}, {1.0, 0}, {1.05, 0.5}, {1, 1.08}, {0, 1.08}}, h);
  const auto start = std::chrono::steady_clock::now();
  const FlatMesh mesh = mesh_polygon(outline, h);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%zu vertices in %.2f s\n", mesh.vertices.size(), seconds);
  EXPECT_GT(mesh.vertices.size(), 48000U);
  EXPECT_LT(seconds, 20.0);
}

class RealMesh : public RealPattern {};

/// The vertices of the panel's own corners, where the pattern may be sharper than any mesh.
TEST_P(RealMesh, HasNoSharpAngleThatThePatternDoesNotForce) {
  for (const double h : {0.015, 0.007}) {
    const Cloth cloth = build_cloth(scene_of(real_pattern(GetParam()), h));
    std::set<int> corners;
    std::vector<char> boundary(cloth.x.size(), 0);
    for (const LabelledVertices& label : cloth.labels) {
      if (label.label.find('/') == std::string::npos) continue;
      corners.insert(label.vertices.front());
      corners.insert(label.vertices.back());
      for (const int v : label.vertices) boundary[static_cast<std::size_t>(v)] = 1;
    }
    std::vector<double> angles;
    int forced = 0, sharp = 0;
    for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
      const auto& flat = cloth.flat[t];
      const double angle = smallest_angle(flat[0], flat[1], flat[2]) / kDegree;
      angles.push_back(angle);
      if (angle >= 20) continue;
      bool excused = false, all_boundary = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const int v = cloth.triangles[t][i];
        all_boundary = all_boundary && boundary[static_cast<std::size_t>(v)];
        excused = excused || corners.count(v) || (flat[(i + 1) % 3] - flat[i]).norm() < 0.4 * h;
      }
      (excused || all_boundary ? forced : sharp) += 1;
    }
    std::sort(angles.begin(), angles.end());
    const auto percentile = [&](double q) {
      return angles[static_cast<std::size_t>(q * static_cast<double>(angles.size() - 1))];
    };
    std::printf(
        "%-20s %2.0f mm %7zu triangles  min %5.1f  0.1%% %5.1f  1%% %5.1f  10%% %5.1f  median %5.1f  forced %d sharp "
        "%d\n",
        GetParam().c_str(), h * 1e3, angles.size(), angles[0], percentile(0.001), percentile(0.01), percentile(0.1),
        percentile(0.5), forced, sharp);
    EXPECT_EQ(sharp, 0);
    EXPECT_GT(percentile(0.1), 40);
    EXPECT_GT(percentile(0.5), 50);
    EXPECT_LT(forced, 0.01 * static_cast<double>(angles.size()) + 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMesh, testing::ValuesIn(kRealPatterns));

}  // namespace
}  // namespace toile
