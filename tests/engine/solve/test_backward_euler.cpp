#include "engine/solve/backward_euler.h"

#include "engine/parallel/state_hash.h"
#include "engine/parallel/thread_limit.h"
#include "engine/terms/contact.h"
#include "tests/engine/solve/sheets.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <random>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kStep = 1e-3;  ///< [s]

struct Trial {
  Trial(const Cloth& cloth, const SolverOptions& options)
      : solver(cloth, options),
        state{cloth.x, Positions(cloth.x.size(), Vec3::Zero())},
        kinematic{std::vector<char>(cloth.x.size(), 0), cloth.x} {}
  StepOutcome step(double h = kStep) {
    StepTimes times;
    return solver.step(state, h, 1, contacts, kinematic, times);
  }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < state.v.size(); ++i) p += solver.masses()[i] * state.v[i];
    return p;
  }
  BackwardEuler solver;
  State state;
  Kinematic kinematic;
  std::vector<Contact> contacts;
};

SolverOptions tight() {
  SolverOptions o;
  o.newton_tolerance = 1e-9;
  o.newton_iterations = 20;
  o.cg_tolerance = 1e-5;
  return o;
}

void shake(State& state, double speed, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, speed);
  for (Vec3& v : state.v)
    for (int k = 0; k < 3; ++k) v[k] += normal(random);
}

/// A sheet lying on the plane through the origin with the given normal, every vertex with its contact.
Trial on_plane(const Vec3& normal, double friction, const SolverOptions& options) {
  const Vec3 across = normal.unitOrthogonal(), along = normal.cross(across);
  // Starts at the depth at which the contact carries a vertex's weight, or nearly.
  const Cloth sheet = equilateral_sheet(
      4, 4, 0.01, suiting(), [&](const Vec2& uv) { return Vec3(uv.x() * across + uv.y() * along + 2e-3 * normal); });
  Trial trial(sheet, options);
  for (int i = 0; i < static_cast<int>(sheet.x.size()); ++i) {
    Contact c;
    c.nodes[0] = i;
    c.weights[0] = 1;
    c.count = 1;
    c.normal = normal;
    c.distance = 2e-3;
    c.friction = friction;
    c.anchor = sheet.x[i];
    trial.contacts.push_back(c);
  }
  return trial;
}

Vec3 mean(const Positions& values) {
  return std::accumulate(values.begin(), values.end(), Vec3(Vec3::Zero())) / double(values.size());
}

}  // namespace

TEST(BackwardEuler, FreeFallIsTheSchemesOwnSolution) {
  SolverOptions options = tight();
  options.cg_tolerance = 1e-6;  // of g h, summed over the steps
  Trial trial(equilateral_sheet(6, 6, 0.01, suiting()), options);
  double v = 0, y = 0;
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(trial.step().accepted);
    v = (v - kStep * kGravity) / (1 + kStep * options.air_drag);
    y += kStep * v;
  }
  for (std::size_t i = 0; i < trial.state.x.size(); ++i) {
    EXPECT_NEAR(trial.state.v[i].y(), v, 1e-6);
    EXPECT_NEAR(trial.state.x[i].y(), y, 1e-8);
  }
}

TEST(BackwardEuler, FreeFlightKeepsMomentumAndLosesEnergy) {
  SolverOptions options = tight();
  options.gravity = false;
  options.air_drag = 0;
  Trial trial(equilateral_sheet(8, 8, 0.01, suiting()), options);
  shake(trial.state, 0.2, 3);
  for (Vec3& v : trial.state.v) v += Vec3(1, -2, 0.5);
  const Vec3 before = trial.momentum();
  const auto total = [&] {
    const Energies e = trial.solver.energies(trial.state, {});
    return e.membrane + e.bending + e.kinetic;
  };
  double energy = total();
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(trial.step().accepted);
    const double now = total();
    EXPECT_LT(now, energy * (1 + 1e-9));
    energy = now;
  }
  EXPECT_LT((trial.momentum() - before).norm(), 1e-5 * before.norm());
}

TEST(BackwardEuler, ALightStiffStripGainsNoEnergy) {
  // One Newton iteration a step, which the absolute tolerance is content with, blows this strip up within 200 steps.
  const double length = 0.05, height = length / 20, edge = height * 2 / std::sqrt(3.0);
  Fabric fabric = isotropic_fabric(0.2, 8000, 2800, 2400, 0.2 * kGravity * length * length * length / 50);
  fabric.bending_damping = 5e-3;
  fabric.membrane_damping = 1e-3;
  const Cloth strip = equilateral_sheet(10, 20, edge, fabric, [](const Vec2& uv) { return Vec3(uv.y(), 0, uv.x()); });
  Trial trial(strip, SolverOptions{});
  for (std::size_t i = 0; i < strip.x.size(); ++i) trial.kinematic.held[i] = strip.x[i].x() < 1.5 * height;
  const auto total = [&] {
    const Energies e = trial.solver.energies(trial.state, {});
    return e.membrane + e.bending + e.gravity + e.kinetic;
  };
  const double weight = kGravity * std::accumulate(trial.solver.masses().begin(), trial.solver.masses().end(), 0.0);
  for (int k = 0; k < 250; ++k) {
    ASSERT_TRUE(trial.step(2e-3).accepted) << k;
    ASSERT_LT(total(), 1e-3 * weight * length) << k;
  }
}

TEST(BackwardEuler, HangingClothComesToRestInBalance) {
  const double edge = 0.02;
  const Cloth sheet = equilateral_sheet(8, 8, edge, suiting(), [](const Vec2& uv) { return Vec3(uv.x(), uv.y(), 0); });
  Trial trial(sheet, SolverOptions{});
  double top = 0;
  for (const Vec3& x : sheet.x) top = std::max(top, x.y());
  for (std::size_t i = 0; i < sheet.x.size(); ++i) trial.kinematic.held[i] = sheet.x[i].y() > top - 1e-9;
  for (int k = 0; k < 1500; ++k) ASSERT_TRUE(trial.step().accepted) << k;
  const Positions force = trial.solver.static_forces(trial.state.x, {});
  const double weight = kGravity * std::accumulate(trial.solver.masses().begin(), trial.solver.masses().end(), 0.0);
  Vec3 reaction = Vec3::Zero();
  double worst = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (trial.kinematic.held[i])
      reaction += force[i];
    else
      worst = std::max(worst, force[i].norm() / (kGravity * trial.solver.masses()[i]));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_NEAR(reaction.y(), -weight, 0.01 * weight);
  const auto kinetic = trial.solver.kinetic_energy(trial.state);
  EXPECT_LT(*std::max_element(kinetic.begin(), kinetic.end()), 1e-8);
}

TEST(BackwardEuler, SameBytesOnAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    ThreadLimit limit(threads);
    const Cloth sheet = equilateral_sheet(60, 60, 0.01, suiting());
    Trial trial(sheet, SolverOptions{});
    trial.kinematic.held[0] = trial.kinematic.held[60] = 1;
    shake(trial.state, 0.3, 9);
    // Contacts of one and of four nodes, with friction, among vertices wherever they are.
    std::mt19937 random(4);
    std::uniform_int_distribution<int> node(0, static_cast<int>(sheet.x.size()) / 4 - 1);
    for (int k = 0; k < 2000; ++k) {
      Contact c;
      c.count = k % 2 ? 1 : 4;
      for (int i = 0; i < 4; ++i) c.nodes[i] = 4 * node(random) + i;
      c.weights = k % 2 ? std::array<double, 4>{1, 0, 0, 0} : std::array<double, 4>{1, -0.2, -0.5, -0.3};
      c.normal = Vec3(0.1, 1, 0.2).normalized();
      c.anchor = contact_point(c, sheet.x);
      c.offset = c.normal.dot(c.anchor) - 1e-3;
      c.distance = 2e-3;
      c.friction = 0.4;
      trial.contacts.push_back(c);
    }
    for (int k = 0; k < 20; ++k) trial.step();
    return sha256_hex(trial.state.x) + sha256_hex(trial.state.v);
  };
  const std::string one = hash(1);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(4));
}

TEST(BackwardEuler, ARejectedStepLeavesEverythingAlone) {
  SolverOptions options;
  options.newton_tolerance = 1e-30;
  options.newton_iterations = 1;
  Trial trial = on_plane(Vec3(0.3, 1, 0).normalized(), 0.01, options);
  shake(trial.state, 0.1, 1);
  const State before = trial.state;
  const Vec3 anchor = trial.contacts[0].anchor;
  const StepOutcome outcome = trial.step();
  EXPECT_FALSE(outcome.accepted);
  EXPECT_EQ(sha256_hex(trial.state.x), sha256_hex(before.x));
  EXPECT_EQ(sha256_hex(trial.state.v), sha256_hex(before.v));
  EXPECT_EQ(trial.contacts[0].anchor, anchor);
}

TEST(BackwardEuler, ANonFiniteStateIsRejected) {
  Trial trial(equilateral_sheet(4, 4, 0.01, suiting()), SolverOptions{});
  trial.state.x[3].x() = std::nan("");
  EXPECT_FALSE(trial.step().accepted);
}

TEST(BackwardEuler, PerfectRestIsNotDivergence) {
  SolverOptions options;
  options.gravity = false;
  Trial trial(equilateral_sheet(6, 6, 0.01, suiting()), options);
  const std::string before = sha256_hex(trial.state.x);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(trial.step().accepted);
  for (std::size_t i = 0; i < trial.state.x.size(); ++i) EXPECT_LT(trial.state.v[i].norm(), 1e-9);
}

TEST(BackwardEuler, HeldVerticesReachTheirTargets) {
  Trial trial(equilateral_sheet(6, 6, 0.01, suiting()), SolverOptions{});
  trial.kinematic.held[0] = 1;
  for (int k = 1; k <= 20; ++k) {
    trial.kinematic.target[0] = Vec3(0, 1e-4 * k, 0);
    ASSERT_TRUE(trial.step().accepted);
    EXPECT_LT((trial.state.x[0] - trial.kinematic.target[0]).norm(), 1e-15);
    EXPECT_NEAR(trial.state.v[0].y(), 0.1, 1e-9);
  }
}

TEST(BackwardEuler, AVertexWithoutMassStays) {
  Cloth sheet = equilateral_sheet(4, 4, 0.01, suiting());
  sheet.x.emplace_back(1, 2, 3);  // belongs to no triangle, so it has no mass
  sheet.vertex_garment.push_back(0);
  Trial trial(sheet, SolverOptions{});
  ASSERT_TRUE(trial.step().accepted);
  EXPECT_EQ(trial.state.x.back(), Vec3(1, 2, 3));
}

TEST(BackwardEuler, IncliningPlaneHoldsAStickingSheetWithoutCreep) {
  const double slope = 0.4, friction = std::tan(slope) * 1.05;
  Trial trial = on_plane(Vec3(std::sin(slope), std::cos(slope), 0), friction, SolverOptions{});
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(trial.step().accepted) << k;
  const Vec3 settled = mean(trial.state.x);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(trial.step().accepted) << k;
  EXPECT_LT((mean(trial.state.x) - settled).norm(), 1e-8);  // 10 nm in a second
  const Positions force = trial.solver.static_forces(trial.state.x, trial.contacts);
  for (std::size_t i = 0; i < force.size(); ++i) EXPECT_LT(force[i].norm(), 0.02 * kGravity * trial.solver.masses()[i]);
}

TEST(BackwardEuler, IncliningPlaneLetsASheetSlideAsCoulombSays) {
  const double slope = 0.4, friction = std::tan(slope) * 0.8;
  SolverOptions options;
  options.air_drag = 0;
  Trial trial = on_plane(Vec3(std::sin(slope), std::cos(slope), 0), friction, options);
  const Vec3 downhill(std::cos(slope), -std::sin(slope), 0);
  const auto speed = [&] { return mean(trial.state.v).dot(downhill); };
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(trial.step().accepted) << k;
  const double early = speed();
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(trial.step().accepted) << k;
  const double expected = kGravity * (std::sin(slope) - friction * std::cos(slope));
  EXPECT_NEAR((speed() - early) / 0.2, expected, 0.01 * expected);
}

TEST(BackwardEuler, ContactForcesCarryTheWeight) {
  Trial trial = on_plane(Vec3::UnitY(), 0.3, SolverOptions{});
  for (int k = 0; k < 500; ++k) ASSERT_TRUE(trial.step().accepted);
  const auto force = trial.solver.contact_forces(trial.state.x, trial.contacts);
  const double weight = kGravity * std::accumulate(trial.solver.masses().begin(), trial.solver.masses().end(), 0.0);
  EXPECT_NEAR(std::accumulate(force.begin(), force.end(), 0.0), weight, 1e-3 * weight);
}
