// Rigid trims in the accurate step: what mechanics says of them without the cloth's help.

#include "engine/geometry/rotation.h"
#include "engine/solve/backward_euler.h"
#include "tests/engine/solve/sheets.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <numbers>

using namespace toile;
using namespace toile::test;

namespace {

SolverOptions tight_with_trims() {
  SolverOptions o;
  o.newton_tolerance = 1e-9;
  o.newton_momentum_fraction = 1e-8;
  o.newton_iterations = 30;
  o.cg_tolerance = 1e-6;
  o.air_drag = 0;
  return o;
}

/// One button beside, or sewn to, one held triangle in the x–z plane with its first corner in the origin.
struct TrimTrial {
  TrimTrial(const RigidBody& body, const RigidState& start, const std::vector<Vec3>& points, double stiffness,
            const SolverOptions& options, double damping = 0) {
    cloth.x = {Vec3(0, 0, 0), Vec3(0, 0, 0.01), Vec3(0.01, 0, 0)};
    cloth.triangles = {{0, 1, 2}};
    cloth.flat = {{Vec2(0, 0), Vec2(0.01, 0), Vec2(0, 0.01)}};
    cloth.triangle_panel = {0};
    cloth.vertex_garment = {0, 0, 0};
    cloth.panels.resize(1);
    cloth.fabrics = {suiting()};
    Trimmings trimmings;
    trimmings.trims = {{body, start}};
    for (const Vec3& p : points) trimmings.attachments.push_back({{0, 1, 2}, {1, 0, 0}, 0, p, stiffness, damping});
    solver = std::make_unique<BackwardEuler>(cloth, options, trimmings);
    state = {cloth.x, Positions(3, Vec3::Zero()), {start}};
    kinematic = {std::vector<char>(3, 1), cloth.x};
  }
  StepOutcome step(double h) {
    StepTimes times;
    std::vector<Contact> none;
    return solver->step(state, h, 1, none, kinematic, times);
  }
  Cloth cloth;
  std::unique_ptr<BackwardEuler> solver;
  State state;
  Kinematic kinematic;
};

const RigidBody kButton = disc_body(0.5e-3, 12e-3, 2.5e-3);

}  // namespace

TEST(RigidBody, ADiscHasTheMomentsOfADisc) {
  EXPECT_NEAR(kButton.inertia.z(), 0.5 * 0.5e-3 * 36e-6, 1e-15);
  EXPECT_NEAR(kButton.inertia.x(), 0.5e-3 * (3 * 36e-6 + 6.25e-6) / 12, 1e-15);
  EXPECT_NEAR(kButton.gyration(), 6e-3 / std::sqrt(2.0), 1e-9);
}

TEST(RigidTrim, FreeFlightKeepsMomentumAndAngularMomentum) {
  SolverOptions options = tight_with_trims();
  options.gravity = false;
  options.newton_tolerance = 1e-11;
  options.newton_momentum_fraction = 1e-11;
  RigidState start;
  start.center = Vec3(0.1, 0.2, 0);
  start.orientation = rotation_by(Vec3(0.3, -0.5, 0.2));
  start.velocity = Vec3(0.2, 0.3, -0.1);
  start.angular_velocity = Vec3(20, 5, -10);  // about no principal axis: it tumbles
  const RigidBody slab{1e-3, {2e-8, 5e-8, 6e-8}};
  TrimTrial trial(slab, start, {}, 0, options);
  const Vec3 before = angular_momentum(slab, start);
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(trial.step(1e-3).accepted);
  const RigidState& end = trial.state.trims[0];
  EXPECT_LT((end.velocity - start.velocity).norm(), 1e-12);
  EXPECT_LT((end.center - start.center - 0.2 * start.velocity).norm(), 1e-12);
  EXPECT_LT((angular_momentum(slab, end) - before).norm(), 1e-6 * before.norm());
  EXPECT_GT((end.angular_velocity - start.angular_velocity).norm(), 1);  // it did tumble
  EXPECT_LE(kinetic_energy_of(slab, end), kinetic_energy_of(slab, start) * (1 + 1e-9));
  EXPECT_NEAR(end.orientation.norm(), 1, 1e-14);
}

TEST(RigidTrim, SpinAboutAPrincipalAxisIsExact) {
  SolverOptions options = tight_with_trims();
  options.gravity = false;
  RigidState start;
  start.angular_velocity = Vec3(0, 0, 50);
  TrimTrial trial(kButton, start, {}, 0, options);
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(trial.step(1e-3).accepted);
  const Eigen::AngleAxisd turned(trial.state.trims[0].orientation);
  EXPECT_NEAR(turned.angle() * turned.axis().z(), 5 - 2 * std::numbers::pi, 1e-6);
}

TEST(RigidTrim, FallsAsGravitySays) {
  TrimTrial trial(kButton, {}, {}, 0, tight_with_trims());
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(trial.step(1e-3).accepted);
  EXPECT_NEAR(trial.state.trims[0].velocity.y(), -0.1 * kGravity, 1e-7);
  EXPECT_NEAR(trial.state.trims[0].center.y(), -0.5 * kGravity * 0.1 * 0.101, 1e-7);  // backward Euler's own sum
}

TEST(RigidTrim, HangsBelowItsSpringByWeightOverStiffness) {
  const double stiffness = 2;
  SolverOptions options = tight_with_trims();
  options.air_drag = 20;
  RigidState start;
  start.center = Vec3(3e-3, -2e-3, 0);                                            // turned away from where it will hang
  TrimTrial trial(kButton, start, {Vec3(6e-3, 0, 0)}, stiffness, options, 0.01);  // by its rim
  for (int k = 0; k < 4000; ++k) ASSERT_TRUE(trial.step(2e-3).accepted);
  const RigidState& end = trial.state.trims[0];
  const Vec3 rim = end.center + end.orientation * Vec3(6e-3, 0, 0);
  const double extension = kButton.mass * kGravity / stiffness;
  EXPECT_NEAR(-rim.y(), extension, 1e-3 * extension);
  std::map<std::string, double> stored;
  for (const TermEnergy& e : trial.solver->energies_by_term(trial.state.x, trial.state.trims))
    stored[e.term] = e.energy;
  EXPECT_NEAR(stored.at("attachment"), 0.5 * stiffness * extension * extension, 2e-3 * stored.at("attachment"));
  EXPECT_LT(std::hypot(end.center.x(), end.center.z()), 1e-3 * 6e-3);  // the centre below the rim
  EXPECT_NEAR(end.center.y(), -extension - 6e-3, 1e-3 * 6e-3);
  const Positions net = trial.solver->static_forces(trial.state.x, {}, trial.state.trims);
  ASSERT_EQ(net.size(), 5u);
  EXPECT_LT(net[3].norm(), 1e-3 * kButton.mass * kGravity);
  EXPECT_LT(net[4].norm(), 1e-3 * kButton.mass * kGravity);
  // What carries it is the held vertex: its own weight and the button's.
  EXPECT_NEAR(net[0].y(), -(kButton.mass + trial.solver->masses()[0]) * kGravity, 1e-3 * kButton.mass * kGravity);
}

TEST(RigidTrim, TwoSpringsBalanceAnOffCentreLoadByTheLawOfTheLever) {
  // A bar whose centre of mass hangs between two springs of different stiffness at -a and +b keeps level where
  // k₁ a = k₂ b, and sinks by m g/(k₁ + k₂).
  const double stiff = 3, a = 2e-3, b = 6e-3;
  SolverOptions options = tight_with_trims();
  options.air_drag = 20;
  TrimTrial trial(kButton, {}, {}, 0, options);
  Trimmings trimmings;
  trimmings.trims = {{kButton, {}}};
  const double k1 = stiff * b / (a + b), k2 = stiff * a / (a + b);
  trimmings.attachments = {{{0, 1, 2}, {1, 0, 0}, 0, Vec3(-a, 0, 0), k1, 0.02},
                           {{0, 1, 2}, {0, 0, 1}, 0, Vec3(b, 0, 0), k2, 0.02}};
  trial.cloth.x = {Vec3(-a, 0, 0), Vec3(0, 0, 0.01), Vec3(b, 0, 0)};
  trial.state.x = trial.kinematic.target = trial.cloth.x;
  trial.solver = std::make_unique<BackwardEuler>(trial.cloth, options, trimmings);
  for (int k = 0; k < 3000; ++k) ASSERT_TRUE(trial.step(2e-3).accepted);
  const RigidState& end = trial.state.trims[0];
  EXPECT_NEAR(-end.center.y(), kButton.mass * kGravity / stiff, 1e-3 * kButton.mass * kGravity / stiff);
  EXPECT_LT((end.orientation * Vec3::UnitX()).cross(Vec3::UnitX()).norm(), 2e-3);
}

TEST(RigidTrim, SwingsWithThePeriodOfThePhysicalPendulum) {
  // Hung stiffly by its rim, turning about its axis: T = 2 pi sqrt(I/(m g r)), I about the rim.
  const double r = 6e-3, about_rim = kButton.inertia.z() + kButton.mass * r * r;
  const double period = 2 * std::numbers::pi * std::sqrt(about_rim / (kButton.mass * kGravity * r));
  RigidState start;
  const double angle = 0.05;  // small
  start.orientation = rotation_by(Vec3(0, 0, angle));
  start.center = start.orientation * Vec3(0, -r, 0);
  TrimTrial trial(kButton, start, {Vec3(0, r, 0)}, 2000, tight_with_trims(), 0.001);
  double previous = start.center.x(), time = 0, first = -1, second = -1;
  const double h = 1e-4;
  while (second < 0 && time < 2 * period) {
    ASSERT_TRUE(trial.step(h).accepted);
    time += h;
    const double now = trial.state.trims[0].center.x();
    if (previous > 0 && now <= 0) first = time - h * now / (now - previous);
    if (previous < 0 && now >= 0 && first > 0) second = time - h * now / (now - previous);
    previous = now;
  }
  EXPECT_NEAR(2 * (second - first), period, 0.005 * period);
}

TEST(RigidTrim, AStateOfOtherTrimsIsRefused) {
  TrimTrial trial(kButton, {}, {}, 0, tight_with_trims());
  trial.state.trims.clear();
  EXPECT_THROW(trial.step(1e-3), std::invalid_argument);
}
