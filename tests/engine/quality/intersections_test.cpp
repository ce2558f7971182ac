#include "engine/quality/intersections.h"

#include "engine/quality/exact_sign.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include <chrono>
#include <iostream>
#include <random>

namespace toile {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Exact = std::array<Rational, 3>;

Exact exact(const Vec3& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }
Exact minus(const Exact& a, const Exact& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Exact cross(const Exact& a, const Exact& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const Exact& a, const Exact& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
int sign(const Rational& r) { return r.sign(); }

int rational_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Exact o = exact(a);
  return sign(dot(minus(exact(b), o), cross(minus(exact(c), o), minus(exact(d), o))));
}

/// Another way to the answer than the library's: the convex sets meet iff no candidate axis separates them strictly.
/// Candidates in exact arithmetic: both normals, all products of edges, and (coplanar) normals of edges in the plane.
bool rational_cross(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  std::array<Exact, 3> a, b;
  for (int k = 0; k < 3; ++k) {
    a[k] = exact(p[k]);
    b[k] = exact(q[k]);
  }
  const auto edge = [](const std::array<Exact, 3>& t, int k) { return minus(t[(k + 1) % 3], t[k]); };
  const Exact na = cross(edge(a, 0), edge(a, 1)), nb = cross(edge(b, 0), edge(b, 1));
  std::vector<Exact> axes{na, nb};
  for (int i = 0; i < 3; ++i) {
    axes.push_back(cross(na, edge(a, i)));
    axes.push_back(cross(nb, edge(b, i)));
    for (int j = 0; j < 3; ++j) axes.push_back(cross(edge(a, i), edge(b, j)));
  }
  for (const Exact& axis : axes) {
    Rational a_low = dot(axis, a[0]), a_high = a_low, b_low = dot(axis, b[0]), b_high = b_low;
    for (int k = 1; k < 3; ++k) {
      const Rational x = dot(axis, a[k]), y = dot(axis, b[k]);
      if (x < a_low) a_low = x;
      if (x > a_high) a_high = x;
      if (y < b_low) b_low = y;
      if (y > b_high) b_high = y;
    }
    if (a_high < b_low || b_high < a_low) return false;
  }
  return true;
}

bool cross(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  return triangles_cross({p[0], p[1], p[2], q[0], q[1], q[2]}, {0, 1, 2}, {3, 4, 5});
}

const std::array<Vec3, 3> kFloor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

TEST(OrientationSign, AgreesWithRationalsOnNearlyCoplanarPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  int zero = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 a(place(random), place(random), place(random)), u(place(random), place(random), place(random)),
        v(place(random), place(random), place(random));
    Vec3 d = a + place(random) * u + place(random) * v;
    if (i % 3 == 0) d.x() = std::nextafter(d.x(), 2.0);
    // On a coarse lattice points are often coplanar exactly.
    const auto snapped = [i](const Vec3& p) { return i % 2 ? p : Vec3((p * 4).array().round() * 0.1); };
    const Vec3 p = snapped(a), q = snapped(a + u), r = snapped(a + v), s = snapped(d);
    const int expected = rational_orientation(p, q, r, s);
    EXPECT_EQ(orientation_sign(p, q, r, s), expected);
    zero += expected == 0;
  }
  EXPECT_GT(zero, 50);
}

TEST(OrientationSign, PlanarAgreesWithRationals) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    const Vec2 a(place(random), place(random)), b(place(random), place(random));
    Vec2 c = a + place(random) * (b - a);
    const Rational area = (Rational(b.x()) - Rational(a.x())) * (Rational(c.y()) - Rational(a.y())) -
                          (Rational(b.y()) - Rational(a.y())) * (Rational(c.x()) - Rational(a.x()));
    EXPECT_EQ(orientation_sign(a, b, c), sign(area));
  }
}

TEST(TrianglesCross, ThroughEachOther) {
  EXPECT_TRUE(cross(kFloor, {Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 1), Vec3(0.9, 0.9, 1)}));
  EXPECT_TRUE(cross(kFloor, {Vec3(-1, -1, -1), Vec3(0.2, 0.2, 0.5), Vec3(3, 3, -1)}));
  EXPECT_FALSE(cross(kFloor, {Vec3(0.8, 0.8, -1), Vec3(0.8, 0.8, 1), Vec3(2, 2, 1)}));
}

TEST(TrianglesCross, TouchCountsAndAGapOfAnyWidthDoesNot) {
  const auto standing = [](double height) {
    return std::array<Vec3, 3>{Vec3(0.2, 0.2, height), Vec3(0.3, 0.2, height + 1), Vec3(0.2, 0.3, height + 1)};
  };
  EXPECT_TRUE(cross(kFloor, standing(0)));
  EXPECT_FALSE(cross(kFloor, standing(1e-12)));
  EXPECT_FALSE(cross(kFloor, standing(5e-324)));
  EXPECT_TRUE(cross(kFloor, standing(-1e-12)));
  // Corner on corner, corner on edge.
  EXPECT_TRUE(cross(kFloor, {Vec3(1, 0, 0), Vec3(2, 0, 1), Vec3(2, 1, 1)}));
  EXPECT_TRUE(cross(kFloor, {Vec3(0.5, 0.5, 0), Vec3(2, 0, 1), Vec3(2, 1, 1)}));
}

TEST(TrianglesCross, Coplanar) {
  EXPECT_TRUE(cross(kFloor, {Vec3(0.1, 0.1, 0), Vec3(0.2, 0.1, 0), Vec3(0.1, 0.2, 0)}));  // within
  EXPECT_TRUE(cross(kFloor, {Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 9, 0)}));           // around
  EXPECT_TRUE(cross(kFloor, {Vec3(0.5, -1, 0), Vec3(0.5, 1, 0), Vec3(2, 0, 0)}));         // across
  EXPECT_FALSE(cross(kFloor, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}));             // beside
  EXPECT_TRUE(cross(kFloor, {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}));              // edge on edge
}

TEST(TrianglesCross, OneSharedVertex) {
  const auto fan = [](const Vec3& p, const Vec3& q) {
    return triangles_cross({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), p, q}, {0, 1, 2}, {3, 0, 4});
  };
  EXPECT_FALSE(fan({-1, 0, 0}, {0, -1, 0}));        // flat neighbours
  EXPECT_FALSE(fan({0.3, 0.3, 1}, {0.4, 0.2, 1}));  // rising
  EXPECT_TRUE(fan({0.3, 0.3, 1}, {0.3, 0.3, -1}));  // its far edge pierces
  EXPECT_TRUE(fan({2, 2, 1}, {2, 2, -1}));          // pierced by the first one's far edge
  EXPECT_FALSE(fan({-2, 2, 1}, {-2, 2, -1}));
  EXPECT_TRUE(fan({0.4, 0.1, 0}, {0.1, 0.4, 0}));  // lying within
  EXPECT_FALSE(fan({0.3, 0.3, 1e-300}, {0.4, 0.2, 1e-300}) && fan({0.3, 0.3, -1e-300}, {0.4, 0.2, -1e-300}));
}

TEST(TrianglesCross, SharedEdgeOnlyWhenFoldedFlat) {
  const auto hinge = [](const Vec3& tip) {
    return triangles_cross({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), tip}, {0, 1, 2}, {1, 0, 3});
  };
  EXPECT_FALSE(hinge({0.5, -1, 0}));
  EXPECT_FALSE(hinge({0.5, 0.8, 1e-12}));
  EXPECT_TRUE(hinge({0.2, 0.3, 0}));
}

TEST(TrianglesCross, DegenerateTrianglesAreNotThereAndDoublesAre) {
  EXPECT_FALSE(cross(kFloor, {Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 1)}));
  EXPECT_TRUE(triangles_cross({kFloor[0], kFloor[1], kFloor[2]}, {0, 1, 2}, {2, 1, 0}));
}

TEST(TrianglesCross, AgreesWithRationalSeparatingAxes) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coarse(0, 3);
  std::uniform_real_distribution<double> place(0, 1);
  int crossing = 0, checked = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vec3, 3> p, q;
    for (auto* t : {&p, &q}) {
      for (Vec3& x : *t) {
        for (int k = 0; k < 3; ++k) x[k] = i % 2 ? place(random) : 0.1 * coarse(random);
      }
    }
    if (i % 4 == 0) {
      for (Vec3& x : q) x.z() = p[0].z();
      for (Vec3& x : p) x.z() = p[0].z();
    }
    const auto has_area = [](const std::array<Vec3, 3>& t) {
      const Exact u = minus(exact(t[1]), exact(t[0])), v = minus(exact(t[2]), exact(t[0])), n = cross(u, v);
      return sign(n[0]) != 0 || sign(n[1]) != 0 || sign(n[2]) != 0;
    };
    if (!has_area(p) || !has_area(q)) continue;
    ++checked;
    const bool expected = rational_cross(p, q);
    crossing += expected;
    EXPECT_EQ(cross(p, q), expected) << i;
    EXPECT_EQ(cross(q, p), expected) << i;
  }
  EXPECT_GT(checked, 2000);
  EXPECT_GT(crossing, 500);
}

struct Sheet {
  Positions x;
  std::vector<Triangle> triangles;
};

Sheet sheet(int n, double size, auto&& height) {
  Sheet s;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double u = size * i / n, v = size * j / n;
      s.x.push_back({u, v, height(u, v)});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      s.triangles.push_back({a, a + 1, a + n + 1});
      s.triangles.push_back({a + 1, a + n + 2, a + n + 1});
    }
  }
  return s;
}

Sheet joined(Sheet a, const Sheet& b) {
  const int offset = static_cast<int>(a.x.size());
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  for (const auto& [p, q, r] : b.triangles) a.triangles.push_back({p + offset, q + offset, r + offset});
  return a;
}

TEST(SelfIntersections, FindsThePairsThatBruteForceFinds) {
  const Sheet both = joined(sheet(12, 1, [](double u, double v) { return 0.1 * std::sin(9 * u + 5 * v); }),
                            sheet(9, 1.1, [](double u, double v) { return 0.1 * std::cos(7 * u - 4 * v); }));
  std::vector<TrianglePair> expected;
  const int n = static_cast<int>(both.triangles.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (triangles_cross(both.x, both.triangles[a], both.triangles[b])) expected.push_back({a, b});
    }
  }
  EXPECT_GT(expected.size(), 20u);
  EXPECT_EQ(self_intersections(both.x, both.triangles), expected);
}

TEST(SelfIntersections, SheetsApartByAPicometreDoNotCross) {
  const auto wave = [](double u, double v) { return 0.1 * std::sin(9 * u + 5 * v); };
  const Sheet low = sheet(20, 1, wave);
  const Sheet high = sheet(20, 1, [&](double u, double v) { return wave(u, v) + 1e-12; });
  const Sheet apart = joined(low, high), same = joined(low, low);
  EXPECT_TRUE(self_intersections(apart.x, apart.triangles).empty());
  EXPECT_GE(self_intersections(same.x, same.triangles).size(), low.triangles.size());
  EXPECT_TRUE(self_intersections({}, {}).empty());
}

TEST(SelfIntersections, ThirtyThousandVerticesInLessThanASecond) {
  const Sheet flat = sheet(170, 1, [](double, double) { return 0.0; });
  const Sheet wavy = sheet(170, 1, [](double u, double v) { return 0.02 * std::sin(40 * u) + 0.013 * v; });
  Sheet tilted = flat;
  for (Vec3& x : tilted.x) x = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()) * x;
  for (const Sheet* s : {&wavy, static_cast<const Sheet*>(&flat), static_cast<const Sheet*>(&tilted)}) {
    const auto start = std::chrono::steady_clock::now();
    const auto pairs = self_intersections(s->x, s->triangles);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::cout << s->x.size() << " vertices: " << seconds << " s, " << pairs.size() << " pairs\n";
    EXPECT_TRUE(pairs.empty());
    EXPECT_LT(seconds, 10);  // one second on an idle machine; tests share it
  }
}

}  // namespace
}  // namespace toile
