#pragma once
// Small scenes of rectangles for tests of sewing and draping: a tube of two panels around an upright cylinder, and what
// is asked of the result.

#include "engine/geometry/body_field.h"
#include "engine/mesh/build_cloth.h"
#include "engine/mesh/topology.h"
#include "engine/mesh/zippers.h"
#include "engine/monitor.h"
#include "engine/quality/intersections.h"
#include "engine/quality/penetration.h"
#include "engine/scene/scene.h"
#include "tests/engine/solve/sheets.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace toile::test {

/// Counter-clockwise rectangle, x from −width/2 to width/2, y from 0 to height. Edges: 0 bottom, 1 right, 2 top, 3
/// left.
inline Panel rectangle_panel(std::string name, double width, double height) {
  Panel panel;
  panel.name = std::move(name);
  panel.vertices = {{-width / 2, 0}, {width / 2, 0}, {width / 2, height}, {-width / 2, height}};
  for (int k = 0; k < 4; ++k) panel.edges.push_back({k, (k + 1) % 4, StraightEdge{}, ""});
  return panel;
}

/// Turned about y, so that its right side looks along (sin angle, 0, cos angle), and put `off` from the axis.
inline Panel around_axis(Panel panel, double angle, double off, double bottom) {
  panel.rotation = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  panel.translation = panel.rotation * Vec3(0, 0, off) + Vec3(0, bottom, 0);
  return panel;
}

/// A front and a back panel, sewn along both sides into a tube around the y axis.
inline Pattern tube_pattern(double half_girth, double height, double off, double bottom) {
  Pattern pattern;
  pattern.panels = {around_axis(rectangle_panel("front", half_girth, height), 0, off, bottom),
                    around_axis(rectangle_panel("back", half_girth, height), std::numbers::pi, off, bottom)};
  pattern.stitches = {{{0, 1}, {1, 3}, false}, {{0, 3}, {1, 1}, false}};
  return pattern;
}

inline Garment garment_of(Pattern pattern, double edge_length, std::string name = "garment") {
  Garment garment;
  garment.name = std::move(name);
  garment.shape = std::move(pattern);
  garment.fabric = suiting();
  garment.fabric.friction_cloth = 0.3;
  garment.edge_length = edge_length;
  return garment;
}

/// Two halves of a front whose panels' inner edges, apart by `gap`, meet in a zipper.
inline Scene zipped_halves(double width, double left_height, double right_height, double gap, double closed_fraction,
                           double bottom = 0) {
  Panel left = rectangle_panel("left", width, left_height), right = rectangle_panel("right", width, right_height);
  left.translation = Vec3(-0.5 * (width + gap), bottom, 0);
  right.translation = Vec3(0.5 * (width + gap), bottom, 0);
  Scene scene;
  scene.garments = {garment_of(Pattern{{left, right}, {}}, 0.02)};
  Zipper zipper;
  zipper.sides = {PinEdge{0, 1}, PinEdge{1, 3}};
  zipper.closed_fraction = closed_fraction;
  scene.garments[0].zippers = {zipper};
  return scene;
}

/// The scene's only garment as a mesh, apart as it is built, its zipper's sides by their vertices.
inline Scene zipped_mesh(const Scene& pattern) {
  const Cloth cloth = build_cloth(pattern);
  const auto sides = zipper_sides(cloth, 0, 0);
  GarmentMesh shape;
  shape.mesh = surface_mesh(cloth);
  Scene scene = pattern;
  scene.garments[0].shape = std::move(shape);
  scene.garments[0].zippers[0].sides = {PinVertices{sides[0]}, PinVertices{sides[1]}};
  return scene;
}

/// Upright, radius 0.1 m, from y = −0.5 to 0.5.
inline Body cylinder_body(double radius = 0.1) {
  return {CylinderBody{Vec3(0, -0.5, 0), Vec3(0, 0.5, 0), radius}, 0.3};
}

/// A tube of girth 0.72 m on a cylinder of girth 0.63 m.
inline Scene tube_scene(double edge_length = 0.03) {
  Scene scene;
  scene.garments = {garment_of(tube_pattern(0.36, 0.15, 0.16, -0.1), edge_length)};
  scene.body = cylinder_body();
  return scene;
}

/// A square of cloth, `side` wide, lying at the height `y` with its middle on the y axis.
inline Garment square_garment(double side, double edge_length, double y, const Fabric& fabric = suiting()) {
  Panel panel = rectangle_panel("square", side, side);
  panel.rotation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();  // right side up
  panel.translation = Vec3(0, y, side / 2);
  Garment garment = garment_of(Pattern{{panel}, {}}, edge_length, "square");
  garment.fabric = fabric;
  return garment;
}

/// Distance of a point from the y axis.
inline double radius_of(const Vec3& p) { return std::hypot(p.x(), p.z()); }

inline bool all_finite(const Positions& x) {
  return std::all_of(x.begin(), x.end(), [](const Vec3& p) { return p.allFinite(); });
}

/// Counts reports, keeps the last, and cancels from the report numbered `cancel_at` (−1: never).
struct CountingMonitor : Monitor {
  explicit CountingMonitor(long cancel_from = -1) : cancel_at(cancel_from) {}
  bool report(const Progress& progress) override {
    rising = rising && progress.fraction_done >= last.fraction_done && progress.fraction_done <= 1;
    last = progress;
    if (stages.empty() || stages.back() != progress.stage) stages.emplace_back(progress.stage);
    return count++ != cancel_at;
  }
  long cancel_at, count = 0;
  bool rising = true;
  Progress last;
  std::vector<std::string> stages;
};

}  // namespace toile::test
