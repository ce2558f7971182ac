// What mechanics says of a button that touches: on a body, on an incline, on cloth, in flight.

#include "engine/geometry/rotation.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/simulate.h"
#include "engine/solve/trim_touching.h"
#include "tests/engine/solve/sheets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kDiameter = 11.5e-3, kThickness = 2.5e-3, kMass = 0.4e-3;

RigidTrim button(const Vec3& center, double friction, const Eigen::Quaterniond& turned = rotation_by(Vec3(0, 0, 0))) {
  RigidTrim trim;
  trim.body = disc_body(kMass, kDiameter, kThickness);
  trim.shape = disc_shape(kDiameter, kThickness);
  trim.start.center = center;
  trim.start.orientation = turned;
  trim.friction = friction;
  return trim;
}

/// A scrap that is held far away: nothing for the button to touch.
Cloth scrap() {
  return equilateral_sheet(1, 1, 0.01, suiting(), [](const Vec2& uv) { return Vec3(uv.x(), 5, uv.y()); });
}
std::vector<HeldVertex> all_held(const Cloth& cloth) {
  std::vector<HeldVertex> held;
  for (std::size_t v = 0; v < cloth.x.size(); ++v) held.push_back({static_cast<int>(v), cloth.x[v], nullptr});
  return held;
}

/// Of the contacts with the body [N].
Vec3 carried(const Simulation& result, const std::vector<RigidTrim>& trims, double stiffness) {
  Vec3 sum = Vec3::Zero();
  for (const TrimContact& c : result.trim_contacts) {
    const RigidState& at = result.trims[c.trim];
    const TrimContactState where =
        trim_contact_state(c, {}, at.center, at.orientation.toRotationMatrix(), trims[c.trim].body.gyration());
    if (c.side > 0) sum += contact_response(c.contact, stiffness, where.point).force;
  }
  return sum;
}

SimulationScene quiet_scene() {
  SimulationScene scene;
  scene.options.rest_kinetic_energy = 1e-18;
  scene.options.newton_tolerance = 1e-10;
  scene.options.newton_momentum_fraction = 1e-4;
  scene.options.newton_iterations = 20;
  scene.options.relaxation_time = 0;
  scene.options.simulated_time_limit = 3;
  return scene;
}

const SimulationProgress kGoOn = [](const SimulationState&) { return true; };
const Eigen::Quaterniond kLying = rotation_by(Vec3(-0.5 * 3.14159265358979323846, 0, 0));  // its axis upright

}  // namespace

class ButtonOnBody : public testing::TestWithParam<bool> {};

TEST_P(ButtonOnBody, ComesToRestAndIsCarriedByItsWeight) {
  const bool sphere = GetParam();
  Body body;
  if (sphere)
    body.shape = SphereBody{Vec3(0, -0.1, 0), 0.1};
  else
    body.shape = PlaneBody{Vec3::Zero(), Vec3::UnitY()};
  const BodyField field = make_body_field(body, 0.01);
  Cloth cloth = scrap();
  SimulationScene scene = quiet_scene();
  scene.body = &field;
  scene.held = all_held(cloth);
  scene.trimmings.trims = {button(Vec3(0, 8e-3, 0), 0.4, rotation_by(Vec3(sphere ? 0 : 0.5, 0, 0)) * kLying)};
  const Simulation result = simulate(cloth, scene, kGoOn);
  const Vec3 force = carried(result, scene.trimmings.trims, scene.options.contact_stiffness);
  const double weight = kMass * kGravity;
  const RigidState& at = result.trims[0];
  std::cout << (sphere ? "sphere" : "plane") << " (" << result.stop_reason << " after " << result.time
            << " s): reference " << weight << " N, ours " << force.y() << ", error over weight "
            << (force / weight - Vec3::UnitY()).norm() << ", at height " << 1e3 * at.center.y() << " mm\n";
  EXPECT_EQ(result.stop_reason, "at_rest");
  EXPECT_LT((force - weight * Vec3::UnitY()).norm(), 1e-4 * weight);
  EXPECT_NEAR(at.center.y(), 0.5 * kThickness, sphere ? 0.1e-3 : 0.01e-3);
  EXPECT_GT(std::abs((at.orientation * Vec3::UnitZ()).y()), sphere ? 0.999 : 1 - 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Bodies, ButtonOnBody, testing::Bool(),
                         [](const auto& test) { return test.param ? "Sphere" : "Plane"; });

namespace {

struct Slide {
  double creep, acceleration;  ///< [m], [m/s²]
};

/// A button on a plane tilted by `slope` [rad].
Slide slide(double friction, double slope, double from, double to) {
  const Vec3 normal(std::sin(slope), std::cos(slope), 0), downhill(std::cos(slope), -std::sin(slope), 0);
  Body body;
  body.shape = PlaneBody{Vec3::Zero(), normal};
  const BodyField plane = make_body_field(body, 0.01);
  Cloth cloth = scrap();
  SimulationScene scene = quiet_scene();
  scene.body = &plane;
  scene.held = all_held(cloth);
  scene.options.air_drag = 0;
  scene.options.early_stop = false;
  const RigidTrim trim = button((0.5 * kThickness - 1e-6) * normal, friction, rotation_by(Vec3(0, 0, -slope)) * kLying);
  struct Moment {
    double time, place;
  };
  const auto moment_at = [&](double time) -> Moment {
    SimulationScene run = scene;
    run.trimmings.trims = {trim};
    run.options.simulated_time_limit = time;
    Cloth copy = cloth;
    const Simulation result = simulate(copy, run, kGoOn);
    return {result.time, result.trims[0].center.dot(downhill)};
  };
  const Moment a = moment_at(from), b = moment_at(0.5 * (from + to)), c = moment_at(to);
  const double early = (b.place - a.place) / (b.time - a.time), late = (c.place - b.place) / (c.time - b.time);
  return {c.place - a.place, (late - early) / (0.5 * (c.time - a.time))};
}

}  // namespace

class ButtonOnIncline : public testing::TestWithParam<double> {};

TEST_P(ButtonOnIncline, SticksAndSlidesAsCoulombSays) {
  const double mu = GetParam();
  const Slide below = slide(mu, 0.97 * std::atan(mu), 0.2, 5.2);
  const double steep = 1.03 * std::atan(mu), expected = kGravity * (std::sin(steep) - mu * std::cos(steep));
  const double ours = slide(mu, steep, 0.5, 1.5).acceleration;
  std::cout << "friction " << mu << ", creep in 5 s: reference 0 mm, ours " << 1e3 * below.creep
            << " mm; acceleration: reference " << expected << " m/s^2, ours " << ours << ", error "
            << 100 * (ours / expected - 1) << " %\n";
  EXPECT_LT(std::abs(below.creep), 1e-5);
  EXPECT_NEAR(ours, expected, 0.02 * expected);
}

INSTANTIATE_TEST_SUITE_P(Coefficients, ButtonOnIncline, testing::Values(0.1, 0.3, 0.7),
                         [](const auto& test) { return "Percent" + std::to_string(std::lround(100 * test.param)); });

TEST(ButtonOnCloth, LiesInASheetWhosePinsCarryBothWeights) {
  Cloth sheet = equilateral_sheet(8, 9, 0.012, suiting());
  SimulationScene scene = quiet_scene();
  scene.options.newton_tolerance = 1e-8;
  scene.options.rest_kinetic_energy = 1e-14;
  scene.options.rest_residual = 1e-5;
  scene.options.simulated_time_limit = 6;
  for (std::size_t v = 0; v < sheet.x.size(); ++v) {
    const Vec3& p = sheet.x[v];
    if ((p.x() < 1e-9 || p.x() > 0.096 - 1e-9) && (p.z() < 1e-9 || p.z() > 9 * 0.012 * std::sqrt(0.75) - 1e-9))
      scene.held.push_back({static_cast<int>(v), p, nullptr});
  }
  ASSERT_EQ(scene.held.size(), 4u);
  for (double height : {4e-3, 60e-3}) {  // laid down, and dropped at a metre a second
    Cloth cloth = sheet;
    SimulationScene run = scene;
    RigidTrim heavy = button(Vec3(0.047, height, 0.045), 0.3, rotation_by(Vec3(0.2, 0, 0.1)) * kLying);
    heavy.body = disc_body(2e-3, kDiameter, kThickness);
    run.trimmings.trims = {heavy};
    const Simulation result = simulate(cloth, run, kGoOn);
    const BackwardEuler solver(cloth, run.options, run.trimmings);
    const Positions force = solver.static_forces(cloth.x, result.contacts, result.trims, result.trim_contacts);
    Vec3 reaction = Vec3::Zero();
    for (const HeldVertex& held : run.held) reaction -= force[held.vertex];
    double weight = 2e-3 * kGravity;
    for (double m : result.mass) weight += kGravity * m;
    double lowest = 1;
    for (const Vec3& p : cloth.x) lowest = std::min(lowest, p.y());
    std::cout << "button from " << 1e3 * height << " mm (" << result.stop_reason << " after " << result.time
              << " s): reference " << weight << " N, ours " << reaction.y() << ", error over weight "
              << (reaction / weight - Vec3::UnitY()).norm() << "; it lies "
              << 1e3 * (result.trims[0].center.y() - lowest) << " mm above the lowest vertex\n";
    EXPECT_EQ(result.stop_reason, "at_rest");
    EXPECT_LT((reaction - weight * Vec3::UnitY()).norm(), 1e-4 * weight);
    EXPECT_GT(result.trims[0].center.y(), lowest);
  }
}

TEST(ButtonInFlight, AButtonThatStrikesASheetKeepsMomentumAndAngularMomentum) {
  double last = 0;
  for (double step : {5e-4, 2.5e-4, 1.25e-4}) {
    const Cloth sheet = equilateral_sheet(6, 7, 0.012, suiting());
    SolverOptions options;
    options.air_drag = 0;
    options.gravity = false;
    options.newton_tolerance = 1e-13;
    options.newton_momentum_fraction = 1e-9;
    options.newton_iterations = 40;
    options.cg_tolerance = 1e-5;
    Trimmings trimmings;
    trimmings.trims = {button(Vec3(0.03, 4e-3, 0.03), 0.4, rotation_by(Vec3(0.3, 0.2, 0)) * kLying)};
    RigidState& start = trimmings.trims[0].start;
    start.velocity = Vec3(0.3, -1, 0);
    start.angular_velocity = Vec3(20, 10, -30);
    BackwardEuler solver(sheet, options, trimmings);
    TouchingOptions touched;
    TrimTouching touching(sheet, trimmings.trims, touched);
    const std::vector<double>& mass = solver.masses();
    const std::size_t n = sheet.x.size();
    State state{sheet.x, Positions(n, Vec3::Zero()), {start}};
    const RigidBody& body = trimmings.trims[0].body;
    const auto momentum = [&](const State& s) {
      Vec3 sum = body.mass * s.trims[0].velocity;
      for (std::size_t v = 0; v < n; ++v) sum += mass[v] * s.v[v];
      return sum;
    };
    const auto spin = [&](const State& s) {
      Vec3 sum = body.mass * s.trims[0].center.cross(s.trims[0].velocity) + angular_momentum(body, s.trims[0]);
      for (std::size_t v = 0; v < n; ++v) sum += mass[v] * s.x[v].cross(s.v[v]);
      return sum;
    };
    const Kinematic free{std::vector<char>(n, 0), state.x};
    const Vec3 momentum_before = momentum(state), spin_before = spin(state);
    std::vector<Contact> none;
    StepTimes times;
    for (int k = 0; k < std::lround(0.02 / step); ++k) {
      std::vector<TrimContact> contacts = touching.detect(state.x, state.trims);
      ASSERT_TRUE(solver.step(state, step, 1, none, free, times, &contacts).accepted) << k;
      touching.remember(contacts, state.x, state.trims);
    }
    const double drift = (momentum(state) - momentum_before).norm() / momentum_before.norm();
    const double turned = (spin(state) - spin_before).norm() / spin_before.norm();
    const Vec3 given = body.mass * (state.trims[0].velocity - start.velocity);
    std::cout << "h = " << 1e3 * step << " ms: momentum reference drift 0, ours " << drift
              << "; angular momentum reference drift 0, ours " << turned
              << (last > 0 ? ", order " + std::to_string(std::log2(last / turned)) : "") << '\n';
    EXPECT_GT(given.norm(), 0.1 * momentum_before.norm()) << "it did strike";
    EXPECT_LT(drift, 1e-10);
    if (last > 0) {
      EXPECT_GT(std::log2(last / turned), 0.7);
    }
    last = turned;
  }
  EXPECT_LT(last, 0.02);
}
