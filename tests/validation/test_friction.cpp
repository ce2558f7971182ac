// Coulomb friction on an incline, through the whole simulation: distance field, contacts, their memory, time steps.

#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/references.h"

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kOffset = 2e-3;

struct Slide {
  double creep = 0;         ///< largest displacement of a vertex between the two times [m]
  double acceleration = 0;  ///< downhill, of the mean, between the two times [m/s²]
};

/// A sheet of 0.1 m by 0.1 m on a plane tilted by `slope` [rad], observed from one time to another [s]. `heading` [rad]
/// turns all about the vertical, `start` is the height over the offset at which the sheet begins.
Slide slide(double friction, double slope, double from, double to, double heading = 0, double start = 0.999) {
  const Mat3 turn = Eigen::AngleAxisd(heading, Vec3::UnitY()).toRotationMatrix();
  const Vec3 normal = turn * Vec3(std::sin(slope), std::cos(slope), 0),
             downhill = turn * Vec3(std::cos(slope), -std::sin(slope), 0), level = turn * Vec3::UnitZ();
  const BodyField plane = make_body_field({PlaneBody{Vec3::Zero(), normal}, friction}, 0.02);
  Cloth sheet = equilateral_sheet(5, 6, 0.02, suiting(), [&](const Vec2& uv) -> Vec3 {
    return uv.x() * downhill + uv.y() * level + start * kOffset * normal;
  });
  SimulationScene scene;
  scene.body = &plane;
  scene.body_friction = friction;
  scene.options.body_offset = kOffset;
  scene.options.air_drag = 0;
  scene.options.early_stop = false;
  scene.options.simulated_time_limit = to;
  struct Moment {
    double time = 0, place = 0;
  } moments[3];  // at the beginning, in the middle, at the end
  Positions first;
  simulate(sheet, scene, [&](const SimulationState& state) {
    for (int k = 0; k < 3; ++k) {
      if (moments[k].time > 0 || state.time < from + 0.5 * k * (to - from) - 1e-9) continue;
      double sum = 0;
      for (const Vec3& p : *state.x) sum += p.dot(downhill);
      moments[k] = {state.time, sum / static_cast<double>(state.x->size())};
      if (k == 0) first = *state.x;
    }
    return true;
  });
  const auto speed = [](const Moment& a, const Moment& b) { return (b.place - a.place) / (b.time - a.time); };
  Slide result;
  for (std::size_t v = 0; v < sheet.x.size(); ++v)
    result.creep = std::max(result.creep, (sheet.x[v] - first[v]).norm());
  result.acceleration =
      (speed(moments[1], moments[2]) - speed(moments[0], moments[1])) / (0.5 * (moments[2].time - moments[0].time));
  return result;
}

}  // namespace

class InclineReference : public testing::TestWithParam<double> {};

TEST_P(InclineReference, SticksJustBelowTheAngleOfFriction) {
  const double slope = 0.97 * std::atan(GetParam());
  const Slide result = slide(GetParam(), slope, 0.2, 10.2);
  std::cout << "friction " << GetParam() << ", creep in 10 s: reference 0 mm, ours " << 1e3 * result.creep << " mm\n";
  EXPECT_LT(result.creep, 1e-3);
}

TEST_P(InclineReference, SlidesJustAboveItAsCoulombSays) {
  const double slope = 1.03 * std::atan(GetParam());
  const double expected = kGravity * (std::sin(slope) - GetParam() * std::cos(slope));
  const double ours = slide(GetParam(), slope, 0.5, 1.5).acceleration;
  std::cout << "friction " << GetParam() << ", acceleration: reference " << expected << " m/s^2, ours " << ours
            << ", error " << 100 * (ours / expected - 1) << " %\n";
  EXPECT_NEAR(ours, expected, 0.02 * expected);
}

INSTANTIATE_TEST_SUITE_P(Coefficients, InclineReference, testing::Values(0.1, 0.2, 0.3, 0.5, 0.7, 1.0),
                         [](const auto& test) { return "Percent" + std::to_string(std::lround(100 * test.param)); });

TEST(FrictionReference, ASteepInclineGivesTheFullAcceleration) {
  const double slope = 0.5, friction = 0.2;
  const double expected = kGravity * (std::sin(slope) - friction * std::cos(slope));
  const double ours = slide(friction, slope, 0.2, 0.5).acceleration;
  std::cout << "acceleration: reference " << expected << " m/s^2, ours " << ours << ", error "
            << 100 * (ours / expected - 1) << " %\n";
  EXPECT_NEAR(ours, expected, 0.01 * expected);
}

TEST(FrictionReference, WhatSlidesFastFeelsItsFrictionWhereverItHeads) {
  const double slope = std::atan(0.6), friction = 0.45;
  const double expected = kGravity * (std::sin(slope) - friction * std::cos(slope));
  for (const double heading : {0.0, 0.7, 0.5 * std::numbers::pi}) {
    const double ours = slide(friction, slope, 0.4, 1.0, heading, 0.95).acceleration;
    std::cout << "heading " << heading << ", acceleration: reference " << expected << " m/s^2, ours " << ours
              << ", error " << 100 * (ours / expected - 1) << " %\n";
    EXPECT_NEAR(ours, expected, 0.02 * expected);
  }
}
