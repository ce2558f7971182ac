// The same drape wherever it happens: turned about the vertical, moved, mirrored, with its vertices in another order.

#include "engine/geometry/body_field.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>
#include <numeric>
#include <random>

using namespace toile;
using namespace toile::test;

namespace {

const Vec3 kBall(0.03, 0, -0.02);  ///< off the sheet's middle, so that no symmetry helps
constexpr double kSide = 0.2;

/// An anisotropic sheet over a ball, one corner held: falls, bends, slides and sticks for 0.2 s.
struct Sheet {
  Cloth cloth;
  std::vector<HeldVertex> held;
};

Sheet sheet() {
  Scene scene;
  Fabric fabric = suiting();
  fabric.stretch_stiffness = {800, 400, 30};
  fabric.bending_stiffness = {8e-6, 4e-6, 5e-6};
  fabric.friction_cloth = 0.3;
  scene.garments = {square_garment(kSide, 0.02, 0.105, fabric)};
  Sheet s{build_cloth(scene), {}};
  std::size_t corner = 0;
  for (std::size_t v = 0; v < s.cloth.x.size(); ++v)
    if (s.cloth.x[v].dot(Vec3(1, 0, 1)) > s.cloth.x[corner].dot(Vec3(1, 0, 1))) corner = v;
  s.held = {{static_cast<int>(corner), s.cloth.x[corner], nullptr}};
  return s;
}

Positions draped(Sheet s, const Vec3& ball_center) {
  const BodyField ball = make_body_field({SphereBody{ball_center, 0.1}, 0.3}, 0.02);
  SimulationScene scene;
  scene.body = &ball;
  scene.body_friction = 0.3;
  scene.held = s.held;
  scene.options.newton_tolerance = 1e-11;
  scene.options.newton_iterations = 50;
  scene.options.cg_tolerance = 1e-5;
  scene.options.cg_iterations = 2000;
  scene.options.early_stop = false;
  scene.options.simulated_time_limit = 0.2;
  simulate(s.cloth, scene, [](const SimulationState&) { return true; });
  return s.cloth.x;
}

const Positions& plain() {
  static const Positions x = draped(sheet(), kBall);
  return x;
}

/// Applies a map of space to start, pins and ball, and demands that the result is mapped likewise.
void moves_along(const char* what, Sheet s, const std::function<Vec3(const Vec3&)>& map) {
  double moved = 0;
  for (std::size_t v = 0; v < s.cloth.x.size(); ++v) moved = std::max(moved, (plain()[v] - s.cloth.x[v]).norm());
  ASSERT_GT(moved, 0.02) << "it falls";
  for (Vec3& p : s.cloth.x) p = map(p);
  for (HeldVertex& h : s.held) h.start = map(h.start);
  const Positions ours = draped(s, map(kBall));
  double farthest = 0;
  for (std::size_t v = 0; v < ours.size(); ++v) farthest = std::max(farthest, (ours[v] - map(plain()[v])).norm());
  std::cout << what << ": reference 0, ours " << farthest / kSide << " of the size\n";
  EXPECT_LT(farthest, 1e-6 * kSide);
}

}  // namespace

TEST(InvarianceReference, Translated) {
  moves_along("translated", sheet(), [](const Vec3& p) -> Vec3 { return p + Vec3(1.3, 0.7, -2.1); });
}

TEST(InvarianceReference, TurnedAboutTheVertical) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3::UnitY()).toRotationMatrix();
  moves_along("turned by 40 degrees", sheet(), [turn](const Vec3& p) -> Vec3 { return turn * p; });
}

TEST(InvarianceReference, Mirrored) {
  // The mirrored cloth: winding and flat pattern are mirrored, too.
  Sheet s = sheet();
  for (std::size_t t = 0; t < s.cloth.triangles.size(); ++t) {
    std::swap(s.cloth.triangles[t][1], s.cloth.triangles[t][2]);
    std::swap(s.cloth.flat[t][1], s.cloth.flat[t][2]);
    for (Vec2& corner : s.cloth.flat[t]) corner.x() = -corner.x();
  }
  moves_along("mirrored", s, [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); });
}

TEST(InvarianceReference, VerticesAndTrianglesInAnotherOrder) {
  Sheet s = sheet();
  const Sheet before = s;
  const std::size_t n = s.cloth.x.size(), triangles = s.cloth.triangles.size();
  std::mt19937 random(11);
  std::vector<int> place(n), order(triangles);
  std::iota(place.begin(), place.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t v = 0; v < n; ++v) s.cloth.x[place[v]] = before.cloth.x[v];
  for (std::size_t t = 0; t < triangles; ++t) {
    const int from = order[t], first = static_cast<int>(random() % 3);
    for (int k = 0; k < 3; ++k) {
      s.cloth.triangles[t][k] = place[before.cloth.triangles[from][(k + first) % 3]];
      s.cloth.flat[t][k] = before.cloth.flat[from][(k + first) % 3];
    }
  }
  for (HeldVertex& h : s.held) h.vertex = place[h.vertex];
  const Positions ours = draped(s, kBall);
  double farthest = 0;
  for (std::size_t v = 0; v < n; ++v) farthest = std::max(farthest, (ours[place[v]] - plain()[v]).norm());
  std::cout << "in another order: reference 0, ours " << farthest / kSide << " of the size\n";
  EXPECT_LT(farthest, 1e-6 * kSide);
}
