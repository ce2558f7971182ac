// Bending that softens and rubs: a strip led through a loop of curvatures, as the KES bending tester does it.

#include "engine/mesh/sewing.h"
#include "tests/validation/strip.h"

#include <gtest/gtest.h>

using namespace toile;
using namespace toile::test;

namespace {

/// A strip of the panel mesher between two clamps, all of it led along circular arcs; the moment is what the arcs'
/// forces do. It hardly resists stretching, since the chords of an arc are shorter than the flat strip.
class BendingTester {
 public:
  static constexpr double kLength = 0.025, kWidth = 0.05;

  explicit BendingTester(const Fabric& fabric) : strip_(held_cloth(scene(fabric))), solver_(strip_.cloth, options()) {
    moment_ = lead(0);
  }

  /// Moment per width [N·m/m] at a curvature [1/m], reached in steps of 1/m that let friction follow.
  double moment(double curvature) {
    while (std::abs(curvature - curvature_) > 1e-9) {
      curvature_ += std::clamp(curvature - curvature_, -1.0, 1.0);
      moment_ = lead(curvature_);
    }
    return moment_;
  }

 private:
  static Scene scene(const Fabric& fabric) {
    StripScene s;
    s.length = kLength;
    s.width = kWidth;
    s.edge = 0.0025;
    Scene scene = strip_scene(s, fabric);
    scene.garments[0].pins.push_back({PinEdge{0, 1}, PinFixed{}, true});
    scene.garments[0].fabric.stretch_stiffness = {1e-3, 1e-3, 5e-4};
    return scene;
  }
  static SolverOptions options() {
    SolverOptions options;
    options.gravity = false;
    return options;
  }

  /// From the start, in the plane's direction; the clamps' points lie on the tangents of both ends.
  Positions arc(double curvature) const {
    Positions x = strip_.cloth.x;
    if (std::abs(curvature) < 1e-9) return x;
    const double turn = curvature * kLength;
    const Vec3 end(std::sin(turn) / curvature, (std::cos(turn) - 1) / curvature, 0),
        tangent(std::cos(turn), -std::sin(turn), 0);
    for (Vec3& p : x) {
      const double along = p.x(), z = p.z();
      if (along > kLength + 1e-9)
        p = end + (along - kLength) * tangent;
      else if (along > 0)
        p = {std::sin(curvature * along) / curvature, (std::cos(curvature * along) - 1) / curvature, 0};
      p.z() = z;
    }
    return x;
  }

  double lead(double curvature) {
    const Positions& flat = strip_.cloth.x;
    State state{flat, Positions(flat.size(), Vec3::Zero())};
    const Kinematic kinematic{std::vector<char>(flat.size(), 1), arc(curvature)};
    std::vector<Contact> none;
    StepTimes times;
    EXPECT_TRUE(solver_.step(state, 1e-3, 1, none, kinematic, times).accepted);
    const Positions force = solver_.static_forces(state.x, none);
    const double d = 1e-3;
    const Positions more = arc(curvature + d), less = arc(curvature - d);
    double work = 0;
    for (std::size_t v = 0; v < flat.size(); ++v) work -= force[v].dot(more[v] - less[v]) / (2 * d);
    return work / (kLength * kWidth);
  }

  HeldCloth strip_;
  BackwardEuler solver_;
  double curvature_ = 0, moment_ = 0;
};

constexpr double kD = 8e-6;  ///< [N·m]

}  // namespace

TEST(BendingLoss, SofteningStripHasTheMeasuredMoment) {
  Fabric fabric = strip_fabric(0.2, {kD, kD, kD});
  fabric.bending_softening = {2.7e-3, 2.7e-3, 2.7e-3};  // the median of Feng et al. 2022
  BendingTester tester(fabric);
  for (double curvature : {10.0, 50.0, 100.0, 150.0}) {
    const double expected = kD * curvature - kD * 2.7e-3 * curvature * curvature, ours = tester.moment(curvature);
    std::printf("curvature %5.0f/m: moment %.2f uN (%.2f)\n", curvature, 1e6 * ours, 1e6 * expected);
    EXPECT_NEAR(ours, expected, 0.02 * expected);
  }
  EXPECT_GT(tester.moment(300), tester.moment(200));
}

TEST(BendingLoss, LoopIsAsWideAsKesMeasuresIt) {
  const double width = 4e-4;  // 2HB = 0.04 gf·cm/cm
  Fabric fabric = strip_fabric(0.2, {kD, kD, kD});
  fabric.bending_hysteresis = {width, width, width};
  fabric.bending_hysteresis_onset = 10;
  BendingTester tester(fabric);
  tester.moment(50);
  const double up = tester.moment(100);
  tester.moment(150);
  const double down = tester.moment(100), slope = (down - tester.moment(50)) / 50;
  std::printf("2HB %.1f uN (%.1f), slope %.3f uN m (%.3f)\n", 1e6 * (up - down), 1e6 * width, 1e6 * slope, 1e6 * kD);
  EXPECT_NEAR(up - down, width, 0.02 * width);
  EXPECT_NEAR(slope, kD, 0.02 * kD);

  // Unloaded, the strip stays bent: D κ = HB.
  double curvature = 50;
  while (tester.moment(curvature) > 0) curvature -= 0.25;
  std::printf("residual curvature %.2f/m (%.2f)\n", curvature, 0.5 * width / kD);
  EXPECT_NEAR(curvature, 0.5 * width / kD, 0.03 * 0.5 * width / kD);
}

TEST(BendingLoss, PressedFoldKeepsItsAngle) {
  // Two panels of 20 mm sewn edge to edge and folded by 60° there: free of weight, they come to rest at it.
  Scene scene;
  Panel left = rectangle_panel("left", 0.02, 0.01), right = left;
  right.name = "right";
  right.translation = Vec3(0.02, 0, 0);
  Garment garment = garment_of(Pattern{{left, right}, {{{0, 1}, {1, 3}, false}}}, 0.0025);
  garment.fabric = strip_fabric(0.2, {kD, kD, kD});
  garment.folds = {{PinEdge{0, 1}, std::numbers::pi / 3, 1}};
  garment.pins = {{PinEdge{0, 3}, PinFixed{}, true}};
  scene.garments = {garment};
  Cloth cloth = build_cloth(scene);
  merge_seams(cloth);
  HeldCloth held{cloth, held_vertices(scene, cloth, {}), static_cast<int>(cloth.x.size())};
  const auto points = add_clamps(held.cloth, held.held);
  held.held.insert(held.held.end(), points.begin(), points.end());
  SolverOptions options;
  options.gravity = false;
  BackwardEuler solver(held.cloth, options);
  settle(solver, held, 0.01, 300, 1e-4);
  Vec3 tip = Vec3::Zero();
  for (const LabelledVertices& l : held.cloth.labels)
    if (l.label == "right/1")
      for (int v : l.vertices) tip += held.cloth.x[v] / static_cast<double>(l.vertices.size());
  const double degrees = std::atan2(-tip.z(), tip.x() - 0.01) * 180 / std::numbers::pi;
  std::printf("fold at %.2f degrees (60)\n", degrees);
  EXPECT_NEAR(degrees, 60, 0.2);
}
