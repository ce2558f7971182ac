#include "engine/solve/simulate.h"

#include "engine/monitor.h"
#include "engine/parallel/state_hash.h"
#include "engine/parallel/thread_limit.h"
#include "engine/terms/contact.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace toile {
namespace {

using namespace test;

const SimulationProgress kGoOn = [](const SimulationState&) { return true; };

/// A limp fabric that comes to rest soon.
Fabric calm() {
  Fabric fabric = suiting();
  fabric.bending_damping = 0.2;
  fabric.friction_cloth = 0.3;
  return fabric;
}

struct OnBall {
  explicit OnBall(double side = 0.2, double edge = 0.02) : ball(make_body_field(body, edge)) {
    Scene scene;
    scene.garments = {square_garment(side, edge, 0.105, calm())};
    cloth = build_cloth(scene);
    simulated.body = &ball;
    simulated.body_friction = 0.3;
  }
  Body body{SphereBody{Vec3::Zero(), 0.1}, 0.3};
  BodyField ball;
  Cloth cloth;
  SimulationScene simulated;
};

double weight_of(const Simulation& simulation) {
  return kGravity * std::accumulate(simulation.mass.begin(), simulation.mass.end(), 0.0);
}

TEST(Simulate, ASquareFallsOnABallAndComesToRest) {
  OnBall scene;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "at_rest");
  EXPECT_LT(result.time, scene.simulated.options.simulated_time_limit);
  EXPECT_EQ(self_intersections(scene.cloth.x, scene.cloth.triangles).size(), 0u);
  EXPECT_LT(deepest_penetration(scene.ball, scene.cloth.x, scene.cloth.triangles).depth, 1e-3);
  double lowest = 1;
  for (const Vec3& p : scene.cloth.x) lowest = std::min(lowest, p.y());
  EXPECT_LT(lowest, 0.07) << "the rim hangs down";
  // At rest the ball carries the weight, and forces balance.
  Vec3 net = Vec3::Zero();
  for (const Vec3& force : result.net_force) net += force;
  EXPECT_LT(net.norm(), 0.02 * weight_of(result));
  EXPECT_GT(std::accumulate(result.contact_force.begin(), result.contact_force.end(), 0.0), 0.9 * weight_of(result));
  EXPECT_GT(result.steps, 0);
  EXPECT_GE(result.newton_iterations, result.steps);
  EXPECT_GE(result.cg_iterations, result.newton_iterations);
  EXPECT_FALSE(result.contacts.empty());
  EXPECT_EQ(result.mass.size(), scene.cloth.x.size());
}

TEST(Simulate, SameBytesOnAnyNumberOfThreadsAndInASecondRun) {
  const auto hash = [](int threads) {
    const ThreadLimit limit(threads);
    OnBall scene(0.24, 0.012);
    scene.simulated.options.simulated_time_limit = 0.15;
    simulate(scene.cloth, scene.simulated, kGoOn);
    return sha256_hex(scene.cloth.x);
  };
  const std::string one = hash(1);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(2));
}

TEST(Simulate, RestIsQuietForTheWholeWindow) {
  OnBall scene;
  scene.simulated.options.rest_window = 0.3;
  double quiet_since = 0, last = 0;
  const Simulation result = simulate(scene.cloth, scene.simulated, [&](const SimulationState& state) {
    EXPECT_GE(state.time, last);
    last = state.time;
    if (state.nodal_energy_p99 >= scene.simulated.options.rest_kinetic_energy) quiet_since = state.time;
    EXPECT_GE(state.kinetic_energy, 0);
    EXPECT_NE(state.x, nullptr);
    return true;
  });
  EXPECT_EQ(result.stop_reason, "at_rest");
  EXPECT_GE(result.time - quiet_since, 0.3 - 1e-9);
}

TEST(Simulate, WithoutEarlyStopItRunsToTheLimitAndSaysThatItIsAtRest) {
  OnBall scene;
  scene.simulated.options.early_stop = false;
  scene.simulated.options.simulated_time_limit = 1.8;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "at_rest");
  EXPECT_GE(result.time, 1.8 - 1e-9);
}

TEST(Simulate, WeightThatGrowsLinearlyFallsByTheCubeOfTime) {
  OnBall scene;
  SolverOptions& options = scene.simulated.options;
  scene.simulated.body = nullptr;
  options.relaxation_time = options.air_drag = 0;
  options.weight_ramp_time = options.simulated_time_limit = 0.4;
  options.max_time_step = 5e-4;
  const Positions before = scene.cloth.x;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  const double t = result.time, fall = kGravity * std::pow(t, 3) / (6 * options.weight_ramp_time);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_NEAR(before[v].y() - scene.cloth.x[v].y(), fall, 0.01 * fall);
}

TEST(Simulate, AWholeSheetFallsAsFastAsItWill) {
  OnBall scene;
  SolverOptions& options = scene.simulated.options;
  scene.simulated.body = nullptr;
  options.relaxation_time = options.air_drag = 0;
  options.simulated_time_limit = 0.6;  // 5.9 mm a step at the end
  const Positions before = scene.cloth.x;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  const double fall = 0.5 * kGravity * std::pow(result.time, 2);
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_NEAR(before[v].y() - scene.cloth.x[v].y(), fall, 0.005 * fall);
  EXPECT_EQ(result.limited_vertices, 0);
}

TEST(Simulate, ATimeLimitInMidFallIsToldAsSuch) {
  OnBall scene;
  scene.simulated.options.simulated_time_limit = 0.15;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "time_limit");
  EXPECT_NEAR(result.time, 0.15, 1.01e-3);
  EXPECT_TRUE(all_finite(scene.cloth.x));
}

TEST(Simulate, AStepThatCannotSucceedEndsTheRunWithTheStartUntouched) {
  OnBall scene;
  scene.simulated.options.newton_tolerance = 1e-30;
  scene.simulated.options.newton_iterations = 1;
  scene.simulated.options.relaxation_time = 0;
  const Positions before = scene.cloth.x;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "step_too_small");
  EXPECT_GT(result.splits, 30);
  EXPECT_EQ(result.steps, 0);
  EXPECT_EQ(scene.cloth.x, before);
}

TEST(Simulate, AStepThatIsNotFiniteIsTakenBack) {
  OnBall scene;
  scene.cloth.x.push_back(Vec3(1, 0, 0));  // in no triangle, so that the step around it succeeds
  scene.cloth.vertex_garment.push_back(0);
  const int loose = static_cast<int>(scene.cloth.x.size()) - 1;
  scene.simulated.held = {{loose, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), nullptr}};
  const Positions before = scene.cloth.x;
  const Simulation result = simulate(scene.cloth, scene.simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "step_too_small");
  EXPECT_EQ(result.steps, 0);
  EXPECT_EQ(scene.cloth.x, before);
  EXPECT_TRUE(all_finite(result.net_force));
}

TEST(Simulate, CancelsWithinAStep) {
  OnBall scene;
  int calls = 0;
  EXPECT_THROW(simulate(scene.cloth, scene.simulated, [&](const SimulationState&) { return ++calls < 4; }), Cancelled);
  EXPECT_EQ(calls, 4);
}

TEST(Simulate, HeldVerticesStayAndTheirNeighboursHang) {
  OnBall scene;
  scene.simulated.body = nullptr;
  for (int v : {0, 1}) scene.simulated.held.push_back({v, scene.cloth.x[v], nullptr});
  scene.simulated.options.simulated_time_limit = 0.5;
  const Positions before = scene.cloth.x;
  simulate(scene.cloth, scene.simulated, kGoOn);
  for (int v : {0, 1}) EXPECT_LT((scene.cloth.x[v] - before[v]).norm(), 1e-12);
  double lowest = 1;
  for (const Vec3& p : scene.cloth.x) lowest = std::min(lowest, p.y());
  EXPECT_LT(lowest, 0.0);
}

TEST(Simulate, MovedVerticesFollowTheirKeyFramesAndRestComesAfterThem) {
  OnBall scene;
  scene.simulated.body = nullptr;
  PinMoved lift;
  lift.key_frames = {{0.2, Vec3::Zero(), Vec3::Zero()}, {0.7, Vec3(0.05, 0.1, 0), Vec3::Zero()}};
  for (std::size_t v = 0; v < scene.cloth.x.size(); ++v)  // the whole cloth, so that it is quiet all the time
    scene.simulated.held.push_back({static_cast<int>(v), scene.cloth.x[v], &lift});
  const Positions before = scene.cloth.x;
  const Simulation result = simulate(scene.cloth, scene.simulated, [&](const SimulationState& state) {
    const Vec3 expected = position_at(scene.simulated.held[7], state.time);
    EXPECT_LT(((*state.x)[7] - expected).norm(), 1e-9) << state.time;
    return true;
  });
  EXPECT_EQ(result.stop_reason, "at_rest");
  EXPECT_GT(result.time, 0.7);
  for (std::size_t v = 0; v < before.size(); ++v)
    EXPECT_LT((scene.cloth.x[v] - before[v] - Vec3(0.05, 0.1, 0)).norm(), 1e-9);
}

TEST(Simulate, TheFabricsOwnFrictionCountsWhereTheBodyGivesNone) {
  const auto slide = [](double body_friction, double fabric_friction) {
    const double slope = 0.3;
    const BodyField plane =
        make_body_field({PlaneBody{Vec3::Zero(), Vec3(std::sin(slope), std::cos(slope), 0)}, 0.3}, 0.02);
    Fabric fabric = calm();
    fabric.friction_body = fabric_friction;
    Cloth cloth = equilateral_sheet(3, 3, 0.02, fabric, [&](const Vec2& uv) -> Vec3 {
      return Vec3(std::cos(slope) * uv.x(), -std::sin(slope) * uv.x(), uv.y()) +
             3e-3 * Vec3(std::sin(slope), std::cos(slope), 0);
    });
    const Vec3 before = cloth.x[0];
    SimulationScene scene;
    scene.body = &plane;
    scene.body_friction = body_friction;
    scene.options.body_offset = 3.01e-3;  // touches from the start
    scene.options.simulated_time_limit = 0.4;
    scene.options.early_stop = false;
    simulate(cloth, scene, kGoOn);
    return (cloth.x[0] - before).norm();
  };
  EXPECT_LT(slide(-1, 0.6), 1e-3);
  EXPECT_GT(slide(-1, 0.0), 0.05);
  EXPECT_GT(slide(0.0, 0.6), 0.05);
}

TEST(Simulate, ALoadBeyondQuadraticRepulsionPressesLayersButNotThroughEachOther) {
  Fabric lead = calm();
  lead.area_density = 5000;
  Scene scene;
  scene.garments = {square_garment(0.06, 0.012, 0, calm()), square_garment(0.04, 0.012, 2e-3, lead)};
  Panel& turned = std::get<Pattern>(scene.garments[1].shape).panels[0];
  turned.rotation = Eigen::AngleAxisd(0.3, Vec3::UnitY()).toRotationMatrix() * turned.rotation;
  Cloth cloth = build_cloth(scene);
  SimulationScene simulated;
  std::size_t held = 0;
  for (std::size_t v = 0; v < cloth.x.size(); ++v)
    if (cloth.vertex_garment[v] == 0) simulated.held.push_back({static_cast<int>(v), cloth.x[v], nullptr}), ++held;
  const Simulation result = simulate(cloth, simulated, kGoOn);
  EXPECT_EQ(result.stop_reason, "at_rest");
  double above = 1, pressed = 0;
  for (std::size_t v = held; v < cloth.x.size(); ++v) above = std::min(above, cloth.x[v].y());
  EXPECT_GT(above, 0);
  const double stiffness = simulated.options.contact_stiffness;
  std::size_t beyond = 0;
  for (const Contact& c : result.contacts) {
    const ContactResponse r = contact_response(c, stiffness, contact_point(c, cloth.x));
    pressed += r.force.y() * (c.nodes[0] < static_cast<int>(held) ? -1 : 1);
    beyond += r.normal_force > stiffness * c.distance;
  }
  EXPECT_NEAR(pressed, 5000 * 0.04 * 0.04 * kGravity, 0.02 * 5000 * 0.04 * 0.04 * kGravity);
  EXPECT_GT(beyond, 0u) << "the load is one that quadratic repulsion could carry";
}

TEST(EstimatedProgress, RisesAndIsOneAtTheLimit) {
  SolverOptions options;
  double last = 0;
  for (int k = 0; k <= 60; ++k) {
    SimulationState state;
    state.time = 0.1 * k;
    const double now = estimated_progress(state, options);
    EXPECT_GE(now, last);
    last = now;
  }
  EXPECT_NEAR(last, 1, 1e-12);
}

}  // namespace
}  // namespace toile
