#include "engine/geometry/body_field.h"

#include "engine/geometry/bvh.h"
#include "engine/geometry/distance.h"
#include "engine/geometry/solid_surface.h"
#include "engine/geometry/winding_number.h"
#include "engine/scene/problem.h"
#include "tests/engine/geometry/mesh_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <random>

namespace toile {
namespace {

using samples::icosphere;

BodyField field_of(const TriangleMesh& mesh, double edge_length = 0.015) {
  return make_body_field(Body{MeshBody{mesh}, 0.3}, edge_length);
}

Vec3 random_in(std::mt19937& random, double half) {
  std::uniform_real_distribution<double> place(-half, half);
  return {place(random), place(random), place(random)};
}

TEST(WindingNumber, OneInsideZeroOutsideAndTwoInTheOverlap) {
  const TriangleMesh mesh = samples::joined(icosphere(3, 0.1), icosphere(3, 0.1, Vec3(0.1, 0, 0)));
  const WindingNumber winding(mesh.vertices, mesh.triangles);
  EXPECT_NEAR(winding({-0.05, 0, 0}), 1, 0.01);
  EXPECT_NEAR(winding({0.05, 0, 0}), 2, 0.02);
  EXPECT_NEAR(winding({0.3, 0.1, 0}), 0, 0.01);
}

TEST(WindingNumber, TreeAgreesWithTheSumOfSolidAngles) {
  TriangleMesh mesh = icosphere(4, 0.1);
  mesh.triangles.resize(mesh.triangles.size() * 2 / 3);  // open
  const WindingNumber tree(mesh.vertices, mesh.triangles);
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 q = random_in(random, 0.2);
    double exact = 0;
    for (const Triangle& t : mesh.triangles) exact += WindingNumber(mesh.vertices, {t})(q);
    EXPECT_NEAR(tree(q), exact, 0.02);
  }
}

TEST(MeshField, SphereIsTheSphere) {
  const double radius = 0.1;
  const BodyField field = field_of(icosphere(5, radius));
  EXPECT_TRUE(field.warnings().empty());
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_in(random, 0.17);
    const BodyField::Sample s = field.sample(p);
    const double exact = p.norm() - radius;
    EXPECT_NEAR(s.distance, field.distance(p), 1e-15);
    EXPECT_NEAR(s.normal.norm(), 1, 1e-9);
    if (std::abs(exact) < 0.01) {
      EXPECT_NEAR(s.distance, exact, 3e-4);
      EXPECT_GT(s.normal.dot(p.normalized()), 0.999);
    } else if (exact < field.band() && p.norm() > 0.02) {
      EXPECT_NEAR(s.distance, exact, 2e-3);
      EXPECT_GT(s.normal.dot(p.normalized()), 0.99);
    }
  }
}

TEST(MeshField, FiniteAndOutwardsFarAwayAndInTheMiddle) {
  const BodyField field = field_of(icosphere(4, 0.1));
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(5, -3, 2), Vec3(1e3, 0, 0), Vec3(0, 0, -0.3), Vec3(0.18, 0.18, 0.18)}) {
    const BodyField::Sample s = field.sample(p);
    EXPECT_TRUE(std::isfinite(s.distance));
    EXPECT_NEAR(s.normal.norm(), 1, 1e-9);
    if (p.norm() > 0.3) {
      EXPECT_GE(s.distance, field.band());
      EXPECT_GT(s.normal.dot(p.normalized()), 0.7);
    }
  }
}

TEST(MeshField, DistanceIsContinuousOverCellsBricksAndTheGridsEnd) {
  const BodyField field = field_of(icosphere(4, 0.1));
  std::mt19937 random(2);
  for (int line = 0; line < 20; ++line) {
    const Vec3 direction = random_in(random, 1).normalized(), start = random_in(random, 0.05);
    double last = field.distance(start);
    for (double t = 0; t < 0.4; t += 1e-4) {
      const double now = field.distance(start + t * direction);
      EXPECT_LT(std::abs(now - last), 1e-4 * 1.3 + 8e-4) << t;  // a jump only where the fine grid ends
      last = now;
    }
  }
}

TEST(MeshField, BoxEdgesAndFacesAreExact) {
  const Vec3 half(0.1, 0.15, 0.05);
  const BodyField mesh = field_of(samples::box_mesh(Vec3::Zero(), half));
  const BodyField exact = make_body_field(Body{BoxBody{Vec3::Zero(), half, Mat3::Identity()}, 0.3}, 0.01);
  std::mt19937 random(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_in(random, 0.2);
    const double expected = exact.distance(p);
    if (std::abs(expected) > 0.01) continue;
    EXPECT_NEAR(mesh.distance(p), expected, 2.5e-3);  // half a voxel at the edges
  }
  EXPECT_NEAR(mesh.distance({0.1012, 0.03, 0.01}), 0.0012, 1e-6);
}

TEST(MeshField, InsideOutIsTurned) {
  const BodyField field = field_of(samples::inside_out(icosphere(4, 0.1)));
  EXPECT_NEAR(field.distance(Vec3::Zero()), -0.1, 0.0125);  // the coarse grid rounds the tip of the cone by a cell
  EXPECT_NEAR(field.distance({0.12, 0, 0}), 0.02, 1e-3);
  ASSERT_EQ(field.warnings().size(), 1u);
}

TEST(MeshField, TrianglesWoundAgainstTheirNeighboursAreTurned) {
  const TriangleMesh ball = icosphere(4, 0.1);
  const BodyField right = field_of(ball);
  TriangleMesh mixed = ball;
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3) std::swap(mixed.triangles[t][1], mixed.triangles[t][2]);
  const BodyField field = field_of(mixed);
  ASSERT_EQ(field.warnings().size(), 1u);
  EXPECT_NE(field.warnings()[0].find("wound against their neighbours"), std::string::npos) << field.warnings()[0];
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.12, 0, 0), Vec3(0.03, 0.08, 0.02), Vec3(0, -0.11, 0.05)})
    EXPECT_EQ(field.distance(p), right.distance(p));
}

TEST(MeshField, TrianglesGivenTwiceOrOnBothSidesCountOnce) {
  const TriangleMesh ball = icosphere(4, 0.1);
  const BodyField right = field_of(ball);
  TriangleMesh twice = ball, both_sides = ball;
  for (const Triangle& t : ball.triangles) {
    twice.triangles.push_back({t[1], t[2], t[0]});
    both_sides.triangles.push_back({t[0], t[2], t[1]});
  }
  for (const TriangleMesh& mesh : {twice, both_sides}) {
    const BodyField field = field_of(mesh);
    EXPECT_TRUE(field.warnings().empty());
    for (const Vec3& p : {Vec3(0.09, 0, 0), Vec3(0.12, 0, 0)}) EXPECT_EQ(field.distance(p), right.distance(p));
  }
}

TEST(MeshField, ClosedPartsThatShareAWallAreOne) {
  const auto box = [](double from, double to) {
    TriangleMesh mesh;
    for (const double x : {from, to})
      for (const double y : {-0.05, 0.05})
        for (const double z : {-0.05, 0.05}) mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 7, 3}, {1, 5, 7}};
    return mesh;
  };
  TriangleMesh first = box(-0.1, 0), second = box(0, 0.1);
  // The same diagonal on both sides of the wall.
  second.triangles[0] = {0, 1, 2};
  second.triangles[1] = {1, 3, 2};
  first.triangles[2] = {4, 6, 5};
  first.triangles[3] = {5, 6, 7};
  const BodyField joined = field_of(samples::joined(first, second)), whole = field_of(box(-0.1, 0.1));
  EXPECT_TRUE(joined.warnings().empty());
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.001, 0.03, 0), Vec3(0, 0.06, 0), Vec3(0.11, 0, 0.01)})
    EXPECT_NEAR(joined.distance(p), whole.distance(p), 1e-6) << p.transpose();
}

TEST(MeshField, CrossingPartsHaveNoSurfaceInside) {
  const double r = 0.1;
  const Vec3 other(0.11, 0, 0);
  const BodyField field = field_of(samples::joined(icosphere(4, r), icosphere(4, r, other)));
  std::mt19937 random(5);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = random_in(random, 0.2);
    const double united = std::min(p.norm(), (p - other).norm()) - r;
    if (united < 0) {
      EXPECT_LT(field.distance(p), 1e-3) << p.transpose();
    }
    if (united > 0 && united < 0.05) {
      EXPECT_NEAR(field.distance(p), united, 2e-3) << p.transpose();
    }
  }
  // Where either sphere's surface passes through the other: far from the united surface.
  EXPECT_LT(field.distance({0.1, 0, 0}), -0.07);
  EXPECT_LT(field.distance({0.01, 0, 0}), -0.07);
}

TEST(MeshField, PartsWhollyInsideDoNotShow) {
  const BodyField field = field_of(samples::joined(icosphere(4, 0.1), icosphere(3, 0.03)));
  EXPECT_NEAR(field.distance(Vec3::Zero()), -0.1, 0.0125);
  EXPECT_NEAR(field.distance({0.03, 0, 0}), -0.07, 2e-3);
}

TEST(MeshField, SmallHolesAreClosedWithAWarning) {
  TriangleMesh mesh = icosphere(4, 0.1);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].y() > 0.092;  // a cap of about 4 cm across
  });
  const BodyField field = field_of(mesh);
  ASSERT_EQ(field.warnings().size(), 1u);
  EXPECT_NE(field.warnings()[0].find("1 hole"), std::string::npos) << field.warnings()[0];
  EXPECT_LT(field.distance({0, 0.05, 0}), -0.03);
  EXPECT_LT(field.distance({0, 0.08, 0}), 0);
  EXPECT_GT(field.distance({0, 0.11, 0}), 0.005);
  EXPECT_NEAR(field.distance({0, -0.09, 0}), -0.01, 1e-3);
  // Up through the hole the distance rises without a step.
  for (double y = 0; y < 0.15; y += 0.0005) {
    EXPECT_LT(std::abs(field.distance({0.001, y + 0.0005, 0}) - field.distance({0.001, y, 0})), 0.0025) << y;
  }
}

TEST(MeshField, OpenSheetsAndNothingAreRefused) {
  TriangleMesh sheet;
  for (int j = 0; j <= 10; ++j) {
    for (int i = 0; i <= 10; ++i) sheet.vertices.push_back({0.1 * i, 0.02 * std::sin(i), 0.1 * j});
  }
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) {
      const int a = 11 * j + i;
      sheet.triangles.push_back({a, a + 1, a + 11});
      sheet.triangles.push_back({a + 1, a + 12, a + 11});
    }
  }
  for (const TriangleMesh& mesh : {sheet, TriangleMesh{}, TriangleMesh{{Vec3::Zero()}, {{0, 0, 0}}, {}, {}, {}, {}}}) {
    try {
      field_of(mesh);
      ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems()[0].code, "body_not_solid");
      EXPECT_EQ(error.problems()[0].pointer, "/body/mesh");
    }
  }
}

TEST(MeshField, SameOnOneThreadAndOnMany) {
  const TriangleMesh mesh = samples::joined(icosphere(4, 0.1), icosphere(4, 0.1, Vec3(0.11, 0.02, 0)));
  const auto field_on = [&](int threads) { return samples::on_threads(threads, [&] { return field_of(mesh); }); };
  const BodyField one = field_on(1), two = field_on(2), four = field_on(4);
  std::mt19937 random(6);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random_in(random, 0.25);
    for (const BodyField* many : {&two, &four}) {
      EXPECT_EQ(one.distance(p), many->distance(p));
      EXPECT_EQ(one.sample(p).normal, many->sample(p).normal);
    }
  }
}

TEST(Overhangs, AHangingArmIsCutLevelWithItsShoulder) {
  // A post with a beam at its top, from the end of which a bar hangs down.
  TriangleMesh body = samples::joined(samples::box_mesh({0, 0.5, 0}, {0.1, 0.5, 0.1}),
                                      samples::box_mesh({0.2, 0.95, 0}, {0.3, 0.05, 0.05}));
  body = samples::joined(body, samples::box_mesh({0.45, 0.7, 0}, {0.04, 0.27, 0.04}));
  const BodyField whole = field_of(body), standing = whole.without_overhangs();
  EXPECT_LT(whole.distance({0.45, 0.6, 0}), -0.02);
  EXPECT_GT(standing.distance({0.45, 0.6, 0}), 0.1);
  EXPECT_LT(standing.distance({0.45, 0.95, 0}), -0.03);
  EXPECT_LT(standing.distance({0, 0.5, 0}), -0.08);
  // The cut closes at the height of the beam's underside.
  EXPECT_NEAR(standing.distance({0.45, 0.88, 0}), 0.02, 0.008);
  EXPECT_NEAR(standing.sample({0.45, 0.88, 0}).normal.y(), -1, 0.05);
}

TEST(PointedToes, AFootGoesStraightDownFromItsAnkle) {
  // A shin, and a foot that reaches forward from it.
  const BodyField whole = field_of(samples::joined(samples::box_mesh({0, 0.5, 0}, {0.05, 0.5, 0.05}),
                                                   samples::box_mesh({0, 0.025, 0.08}, {0.05, 0.025, 0.13}))),
                  pointed = whole.with_pointed_toes();
  EXPECT_NEAR(whole.ankle(), 0.06, 1e-3);
  EXPECT_LT(whole.distance({0, 0.03, 0.15}), -0.01);
  EXPECT_GT(pointed.distance({0, 0.03, 0.15}), 0.005);
  for (const double y : {-0.5, -0.01, 0.03}) {
    EXPECT_LT(pointed.distance({0, y, 0.03}), -0.01);
    const BodyField::Sample before = pointed.sample({0, y, 0.06});
    EXPECT_NEAR(before.distance, 0.01, 2e-3);
    EXPECT_NEAR(before.normal.norm(), 1, 1e-12);
    EXPECT_GT(before.normal.z(), 0.9);
    EXPECT_EQ(before.normal.y(), 0);
  }
  for (const double y : {0.07, 0.5, 0.99})
    EXPECT_EQ(pointed.distance({0.02, y, 0.06}), whole.distance({0.02, y, 0.06}));
  EXPECT_EQ(pointed.bounds().lower, whole.bounds().lower);
}

TEST(PointedToes, ABodyWithoutEndStaysAsItIs) {
  const BodyField ground = make_body_field(Body{PlaneBody{}, 0.3}, 0.02);
  EXPECT_EQ(ground.with_pointed_toes().distance({0, -1, 0}), ground.distance({0, -1, 0}));
}

struct RealBody {
  const char* path;
  bool z_up, arms_hang;
};

class RealBodies : public testing::TestWithParam<RealBody> {};

/// The kept surface is the reference; the field's interpolation and sign are what is tested.
TEST_P(RealBodies, FieldAgreesWithExactDistances) {
  std::optional<TriangleMesh> mesh = samples::read_obj(std::string(TOILE_SHARED) + "/data/" + GetParam().path);
  if (!mesh) GTEST_SKIP() << "no ../shared";
  if (GetParam().z_up) mesh = samples::y_up(*mesh);
  const auto start = std::chrono::steady_clock::now();
  const BodyField field = field_of(*mesh);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const SolidSurface surface = make_solid_surface(*mesh, 0.005);
  const SoupSolid& solid = surface.solid;
  std::vector<Box> boxes;
  std::vector<double> area_up_to;
  double area = 0;
  for (const auto& [a, b, c] : solid.triangles) {
    boxes.push_back(triangle_box(solid.vertices[a], solid.vertices[b], solid.vertices[c]));
    area += (solid.vertices[b] - solid.vertices[a]).cross(solid.vertices[c] - solid.vertices[a]).norm();
    area_up_to.push_back(area);
  }
  const Bvh bvh(boxes);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> errors;
  std::vector<Vec3> points;
  for (int i = 0; i < 20000; ++i) {
    const size_t t = std::lower_bound(area_up_to.begin(), area_up_to.end(), area * unit(random)) - area_up_to.begin();
    const Vec3 &a = solid.vertices[solid.triangles[t][0]], &b = solid.vertices[solid.triangles[t][1]],
               &c = solid.vertices[solid.triangles[t][2]];
    const Vec3 p = (a + b + c) / 3 + 0.008 * (unit(random) - 0.5) * (b - a).cross(c - a).normalized();
    points.push_back(p);
    double best = 1;
    bvh.nearest(p, best, [&](int k) {
      const auto& [x, y, z] = solid.triangles[k];
      const double squared =
          point_triangle(p, solid.vertices[x], solid.vertices[y], solid.vertices[z]).squared_distance;
      best = std::min(best, squared);
      return squared;
    });
    const double exact = solid.inside(p) ? -std::sqrt(best) : std::sqrt(best);
    errors.push_back(std::abs(field.distance(p) - exact));
  }
  std::sort(errors.begin(), errors.end());
  std::cout << GetParam().path << ": " << seconds << " s, error median " << errors[10000] * 1e3 << " mm, 90 % "
            << errors[18000] * 1e3 << " mm, 99 % " << errors[19800] * 1e3 << " mm, max " << errors.back() * 1e3
            << " mm\n";
  const auto began = std::chrono::steady_clock::now();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += field.sample(p).normal;
  const double taken = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - began).count();
  std::cout << "  " << taken / points.size() << " ns a sample at random places, mean normal "
            << (sum / points.size()).transpose() << "\n";
  for (const std::string& warning : field.warnings()) std::cout << "  " << warning << "\n";
  EXPECT_LT(errors[10000], 0.05e-3);
  EXPECT_LT(errors[18000], 0.3e-3);
  EXPECT_LT(errors.back(), 5e-3);  // creases between fingers and behind ears, a voxel at most
}

TEST_P(RealBodies, ArmsInAnAPoseAreCutAndTheRestStays) {
  std::optional<TriangleMesh> mesh = samples::read_obj(std::string(TOILE_SHARED) + "/data/" + GetParam().path);
  if (!mesh) GTEST_SKIP() << "no ../shared";
  if (GetParam().z_up) mesh = samples::y_up(*mesh);
  const BodyField whole = field_of(*mesh, 0.018), standing = whole.without_overhangs();
  const Box all = whole.bounds(), rest = standing.bounds();
  std::cout << GetParam().path << ": whole " << all.lower.transpose() << " .. " << all.upper.transpose()
            << ", standing " << rest.lower.transpose() << " .. " << rest.upper.transpose() << "\n";
  EXPECT_NEAR(rest.lower.y(), all.lower.y(), 1e-3);
  EXPECT_NEAR(rest.upper.y(), all.upper.y(), 1e-3);
  if (!GetParam().arms_hang) return;
  EXPECT_LT(rest.upper.x(), 0.40);
  EXPECT_GT(rest.lower.x(), -0.40);
  const double height = all.upper.y() - all.lower.y();
  // Torso, both legs and head are as they were; nothing is left below the armpits beyond the hips.
  for (double at : {0.3, 0.55, 0.65, 0.93}) {
    for (double x = -0.12; x <= 0.12; x += 0.02) {
      const Vec3 p(x, all.lower.y() + at * height, 0);
      EXPECT_NEAR(standing.distance(p) < 0, whole.distance(p) < 0, 0) << p.transpose();
    }
  }
  for (double at = 0.4; at < 0.68; at += 0.01) {
    for (double x : {0.32, 0.4, 0.5, 0.6}) EXPECT_GT(standing.distance({x, all.lower.y() + at * height, 0}), 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, RealBodies,
                         testing::Values(RealBody{"bodies/mean_all.obj", false, true},
                                         RealBody{"bodies/f_smpl_average_A40.obj", false, true},
                                         RealBody{"cipc/wm2_15k.obj", true, false}),
                         [](const auto& instance) {
                           std::string name = instance.param.path;
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

}  // namespace
}  // namespace toile
