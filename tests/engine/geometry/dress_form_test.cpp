#include "engine/geometry/dress_form.h"

#include "engine/geometry/body_field.h"
#include "engine/geometry/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace toile {
namespace {

/// Loops of the horizontal cut, each as the crossed mesh edges that its triangles join.
std::map<std::pair<int, int>, std::vector<Vec2>> cut_loops(const TriangleMesh& mesh, double height) {
  using Edge = std::pair<int, int>;
  std::map<Edge, Edge> parent;
  std::map<Edge, Vec2> crossing;
  const auto root = [&](Edge e) {
    while (parent.at(e) != e) e = parent.at(e);
    return e;
  };
  for (const Triangle& t : mesh.triangles) {
    std::vector<Edge> crossed;
    for (int k = 0; k < 3; ++k) {
      const Edge e{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
      const Vec3 &a = mesh.vertices[e.first], &b = mesh.vertices[e.second];
      if ((a.y() < height) == (b.y() < height)) continue;
      const Vec3 p = a + (height - a.y()) / (b.y() - a.y()) * (b - a);
      parent.try_emplace(e, e);
      crossing.try_emplace(e, p.x(), p.z());
      crossed.push_back(e);
    }
    if (crossed.size() == 2) parent[root(crossed[0])] = root(crossed[1]);
  }
  std::map<Edge, std::vector<Vec2>> loops;
  for (const auto& [edge, point] : crossing) loops[root(edge)].push_back(point);
  return loops;
}

/// Closed tape around the trunk at a height: the hull (Andrew's monotone chain) of the loops that cross the middle.
double tape(const TriangleMesh& mesh, double height) {
  std::vector<Vec2> points;
  for (const auto& [start, loop] : cut_loops(mesh, height)) {
    const auto [low, high] =
        std::minmax_element(loop.begin(), loop.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
    if (low->x() < 0 && high->x() > 0) points.insert(points.end(), loop.begin(), loop.end());
  }
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Vec2> hull;
  const auto extend = [&](const Vec2& p, size_t base) {
    while (hull.size() >= base + 2) {
      const Vec2 u = hull.back() - hull[hull.size() - 2], v = p - hull.back();
      if (u.x() * v.y() - u.y() * v.x() > 0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2& p : points) extend(p, 0);
  const size_t base = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) extend(*p, base);
  double length = 0;
  for (size_t i = 1; i < hull.size(); ++i) length += (hull[i] - hull[i - 1]).norm();
  return length;
}

class DressForms : public testing::TestWithParam<DressFormBody> {};

TEST_P(DressForms, MeasuresAsAskedFor) {
  const DressFormBody body = GetParam();
  const DressFormMeasures lines = dress_form_measures(body);
  const TriangleMesh mesh = dress_form(body);
  const double bust = tape(mesh, lines.bust), waist = tape(mesh, lines.waist);
  const double hip = tape(mesh, lines.hip), neck = tape(mesh, lines.neck);
  std::cout << mesh.triangles.size() << " triangles; bust " << bust << " waist " << waist << " hip " << hip << " neck "
            << neck << "\n";
  EXPECT_NEAR(bust, body.bust, 0.01 * body.bust);
  EXPECT_NEAR(waist, body.waist, 0.01 * body.waist);
  EXPECT_NEAR(hip, body.hip, 0.01 * body.hip);
  EXPECT_NEAR(neck, body.neck, 0.01 * body.neck);
}

TEST_P(DressForms, ClosedOutwardAndSymmetric) {
  const DressFormBody body = GetParam();
  const TriangleMesh mesh = dress_form(body);
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first}));
  }
  EXPECT_GT(volume, 0.03);
  const Box box = bounding_box(mesh.vertices);
  EXPECT_NEAR(box.lower.y(), 0, 2e-3);
  EXPECT_NEAR(box.lower.x(), -box.upper.x(), 1e-4);
  EXPECT_NEAR(box.upper.y(), 0.886 * body.height, 0.02);
  const BodyField field = make_body_field(Body{body, 0.3}, 0.018);
  EXPECT_TRUE(field.warnings().empty());
  double asymmetry = 0;
  for (const Vec3& x : mesh.vertices) asymmetry = std::max(asymmetry, std::abs(field.distance({-x.x(), x.y(), x.z()})));
  EXPECT_LT(asymmetry, 2.5e-3);
}

INSTANTIATE_TEST_SUITE_P(Sizes, DressForms,
                         testing::Values(DressFormBody{}, DressFormBody{1.60, 0.82, 0.64, 0.88, 0.37, 0.33},
                                         DressFormBody{1.80, 1.16, 1.02, 1.22, 0.43, 0.41}),
                         [](const auto& instance) {
                           return "height" + std::to_string(int(instance.param.height * 100));
                         });

TEST(DressForm, SameBytesEveryTime) {
  const TriangleMesh a = dress_form({}), b = dress_form({});
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(DressForm, LinesFollowTheProportions) {
  const DressFormMeasures m = dress_form_measures({});
  EXPECT_TRUE(m.knee < m.crotch && m.crotch < m.hip && m.hip < m.high_hip && m.high_hip < m.waist &&
              m.waist < m.underbust && m.underbust < m.bust && m.bust < m.underarm && m.underarm < m.shoulder &&
              m.shoulder < m.neck_base && m.neck_base < m.neck);
}

}  // namespace
}  // namespace toile
