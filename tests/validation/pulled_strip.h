#pragma once
// A uniaxial test as a laboratory would wish it: a meshed strip pulled through the solver, clamps that do not disturb.

#include "engine/experiments/uniaxial.h"
#include "engine/mesh/build_cloth.h"
#include "engine/solve/backward_euler.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace toile::test {

struct PulledStrip {
  double force_per_width = 0;  ///< reaction at an end along the pull, per rest width [N/m]
  double lateral = 0;          ///< stretch across the pull in the middle
};

/// Pulls a strip of 120 mm by 20 mm, its warp turned by `grain_deg` from the pull, to a stretch. The ends are held
/// where the map of the middle third puts them, again and again until that moves no more: sides and ends are then in
/// the one homogeneous state of uniaxial tension, shear included, and only the stretch along the pull is prescribed.
inline PulledStrip pull_strip(const Fabric& fabric, double grain_deg, double stretch, double edge_length = 5e-3) {
  const double length = 0.12, width = 0.02;
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("strip", width, length)}, {}}, edge_length)};
  scene.garments[0].fabric = fabric;
  scene.garments[0].grain = grain_deg * std::numbers::pi / 180;
  const Cloth strip = build_cloth(scene);
  BackwardEuler solver(strip, pull_options());
  const Positions& rest = strip.x;
  const std::size_t n = rest.size();
  Kinematic ends{std::vector<char>(n, 0), rest};
  for (std::size_t v = 0; v < n; ++v) ends.held[v] = rest[v].y() < 1e-9 || rest[v].y() > length - 1e-9;

  const auto middle = [&](const Positions& x) {
    Mat2 sum = Mat2::Zero();
    double area = 0;
    for (const Triangle& t : strip.triangles) {
      const Vec3 center = (rest[t[0]] + rest[t[1]] + rest[t[2]]) / 3;
      if (std::abs(center.y() - 0.5 * length) > length / 6) continue;
      Mat2 flat, now;
      for (int k = 0; k < 2; ++k) {
        flat.col(k) = (rest[t[k + 1]] - rest[t[0]]).head<2>();
        now.col(k) = (x[t[k + 1]] - x[t[0]]).head<2>();
      }
      const double weight = std::abs(flat.determinant());
      sum += weight * now * flat.inverse();
      area += weight;
    }
    return Mat2(sum / area);
  };

  State state{rest, Positions(n, Vec3::Zero())};
  std::vector<Contact> none;
  StepTimes times;
  Mat2 map = Mat2::Identity();
  for (int round = 0; round < 40; ++round) {
    // The pull's own column is prescribed: along y, `stretch` long.
    Mat2 wanted = map;
    wanted.col(1) = Vec2(0, 1 + std::min(1.0, (round + 1) / 10.0) * (stretch - 1));
    for (std::size_t v = 0; v < n; ++v) ends.target[v].head<2>() = wanted * rest[v].head<2>();
    const Mat2 before = map;
    for (int k = 0; k < 10; ++k) EXPECT_TRUE(solver.step(state, 0.02, 1, none, ends, times).accepted);
    map = middle(state.x);
    const double turn = std::atan2(-map(0, 1), map(1, 1));  // what is left of the column's slant is a rotation
    map = Eigen::Rotation2Dd(-turn).toRotationMatrix() * map;
    if (round > 10 && (map - before).norm() < 1e-8) break;
  }
  const Positions force = solver.static_forces(state.x, none);
  PulledStrip result;
  for (std::size_t v = 0; v < n; ++v)
    if (ends.held[v] && rest[v].y() > 0.5 * length) result.force_per_width -= force[v].y() / width;
  result.lateral = map.determinant() / map.col(1).norm();  // across the pull: the rest width's image, projected
  return result;
}

}  // namespace toile::test
