// What no solver may lose or gain: momentum in free flight, energy of a closed system, the balance of weight and
// reactions at rest.

#include "engine/geometry/body_field.h"
#include "engine/solve/backward_euler.h"
#include "engine/solve/simulate.h"
#include "engine/terms/contact.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

using namespace toile;
using namespace toile::test;

namespace {

const SimulationProgress kGoOn = [](const SimulationState&) { return true; };

SolverOptions closed_system() {
  SolverOptions options;
  options.air_drag = 0;
  options.gravity = false;
  options.newton_tolerance = 1e-13;
  options.newton_iterations = 30;
  options.cg_tolerance = 1e-5;
  return options;
}

struct Flight {
  double momentum_drift = 0;  ///< of the sum, over the sum of magnitudes
  double torque = 0;          ///< largest of internal forces in a step, over Σ |x × m v|
  double spin_drift = 0;      ///< of the angular momentum, over itself
};

/// A crumpled, spinning sheet thrown without air: stretch, shear, bending and their damping act, nothing from outside.
Flight fly(double step, double time) {
  const Cloth sheet = equilateral_sheet(8, 9, 0.02, suiting(), [](const Vec2& uv) -> Vec3 {
    return {uv.x(), 0.01 * std::sin(40 * uv.x()) * std::cos(30 * uv.y()), 1.02 * uv.y()};
  });
  BackwardEuler solver(sheet, closed_system());
  const std::vector<double>& mass = solver.masses();
  const std::size_t n = sheet.x.size();
  State state{sheet.x, Positions(n)};
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.02);
  for (std::size_t v = 0; v < n; ++v)
    state.v[v] =
        Vec3(2, 1, -1) + Vec3(3, -2, 4).cross(state.x[v]) + Vec3(normal(random), normal(random), normal(random));
  const auto momentum = [&](const Positions& velocity) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < n; ++v) sum += mass[v] * velocity[v];
    return sum;
  };
  const auto spin = [&](const Positions& at, const Positions& velocity) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < n; ++v) sum += mass[v] * at[v].cross(velocity[v]);
    return sum;
  };
  const Kinematic free{std::vector<char>(n, 0), state.x};
  std::vector<Contact> none;
  StepTimes times;
  const Vec3 momentum_before = momentum(state.v), spin_before = spin(state.x, state.v);
  Flight flight;
  for (int k = 0; k < std::lround(time / step); ++k) {
    const State before = state;
    EXPECT_TRUE(solver.step(state, step, 1, none, free, times).accepted) << k;
    // h Σ x × F of the step's internal forces, at the positions at which they act.
    const Vec3 torque = spin(state.x, state.v) - spin(state.x, before.v);
    flight.torque = std::max(flight.torque, torque.norm() / spin_before.norm());
  }
  flight.momentum_drift = (momentum(state.v) - momentum_before).norm() / momentum_before.norm();
  flight.spin_drift = (spin(state.x, state.v) - spin_before).norm() / spin_before.norm();
  return flight;
}

}  // namespace

TEST(ConservationReference, FreeFlightKeepsMomentum) {
  const Flight flight = fly(1e-3, 0.1);
  std::cout << "momentum after 100 steps: reference drift 0, ours " << flight.momentum_drift
            << "\ntorque of internal forces in a step, over the angular momentum: reference 0, ours " << flight.torque
            << '\n';
  EXPECT_LT(flight.momentum_drift, 1e-12);
  EXPECT_LT(flight.torque, 1e-12);
}

TEST(ConservationReference, AngularMomentumDriftsByTheIntegratorAloneAtFirstOrder) {
  // Backward Euler's L grows by h Σ m v₁ × v₀ a step whatever the forces do: the drift over a time falls with h.
  double last = 0;
  for (double step : {1e-3, 5e-4, 2.5e-4}) {
    const double drift = fly(step, 0.05).spin_drift;
    std::cout << "angular momentum after 0.05 s at h = " << 1e3 * step << " ms: reference drift 0, ours " << drift
              << (last > 0 ? ", order " + std::to_string(std::log2(last / drift)) : "") << '\n';
    if (last > 0) {
      EXPECT_GT(std::log2(last / drift), 0.9);
    }
    last = drift;
  }
  EXPECT_LT(last, 0.01);
}

TEST(ConservationReference, EnergyNeverGrowsByMoreThanTheResidualsWork) {
  for (bool tight : {true, false}) {
    Fabric fabric = suiting();
    fabric.membrane_damping = fabric.bending_damping = 0;
    // So stiff that no hinge is turned through 180°, where bending energy jumps and which here no contact prevents.
    fabric.bending_stiffness = {5e-5, 5e-5, 5e-5};
    const Cloth sheet = equilateral_sheet(10, 11, 0.02, fabric);
    SolverOptions options = tight ? closed_system() : SolverOptions{};
    options.gravity = true;
    options.air_drag = 0;
    BackwardEuler solver(sheet, options);
    const std::size_t n = sheet.x.size();
    State state{sheet.x, Positions(n, Vec3::Zero())};
    Kinematic corners{std::vector<char>(n, 0), sheet.x};
    for (std::size_t v = 0; v < n; ++v) corners.held[v] = sheet.x[v].z() < 1e-9 && sheet.x[v].x() < 0.03;
    std::vector<Contact> none;
    StepTimes times;
    const auto total = [&] {
      const Energies e = solver.energies(state, none);
      return e.membrane + e.bending + e.gravity + e.kinetic;
    };
    const double at_first = total();
    double before = at_first, worst = -1, swung = 0;
    for (int k = 0; k < 1000; ++k) {
      const StepOutcome outcome = solver.step(state, 1e-3, 1, none, corners, times);
      ASSERT_TRUE(outcome.accepted) << k;
      double speed2 = 0;
      for (const Vec3& v : state.v) speed2 += v.squaredNorm();
      const double after = total(), allowed = outcome.residual * std::sqrt(speed2);
      swung = std::max(swung, solver.energies(state, none).kinetic);
      worst = std::max(worst, after - before - allowed);
      before = after;
    }
    std::cout << (tight ? "tight" : "default") << " tolerances: largest growth in a step beyond the residual's work "
              << worst << " J, swing " << swung << " J, lost in 1 s " << at_first - before << " J\n";
    EXPECT_GT(swung, 1e-3) << "something moves";
    EXPECT_LT(worst, 1e-9 * swung);
    EXPECT_LT(before, at_first);
  }
}

TEST(ConservationReference, PinsCarryTheWeightOfAHangingSheet) {
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("sheet", 0.3, 0.3)}, {}}, 0.02)};
  Cloth sheet = build_cloth(scene);
  SimulationScene simulated;
  for (std::size_t v = 0; v < sheet.x.size(); ++v)
    if (sheet.x[v].y() > 0.3 - 1e-9 && std::abs(std::abs(sheet.x[v].x()) - 0.15) < 1e-9)
      simulated.held.push_back({static_cast<int>(v), sheet.x[v], nullptr});
  ASSERT_EQ(simulated.held.size(), 2u);
  for (Vec3& p : sheet.x) p.z() = 1e-3 * std::sin(20 * p.x() + 10 * p.y());
  for (HeldVertex& held : simulated.held) held.start = sheet.x[held.vertex];
  simulated.options.rest_kinetic_energy = 1e-14;
  simulated.options.rest_residual = 1e-5;
  simulated.options.newton_tolerance = 1e-8;
  simulated.options.simulated_time_limit = 8;
  const Simulation result = simulate(sheet, simulated, kGoOn);
  const BackwardEuler solver(sheet, simulated.options);
  const Positions force = solver.static_forces(sheet.x, result.contacts);
  Vec3 reaction = Vec3::Zero();
  double weight = 0;
  for (double m : result.mass) weight += kGravity * m;
  for (const HeldVertex& held : simulated.held) reaction -= force[held.vertex];
  const Vec3 error = (reaction - Vec3(0, weight, 0)) / weight;
  std::cout << "reactions at two corners (" << result.stop_reason << " after " << result.time << " s): reference "
            << weight << " N, ours " << reaction.y() << ", error over weight " << error.norm() << '\n';
  EXPECT_LT(error.norm(), 1e-4);
}

TEST(ConservationReference, ASphereCarriesTheWeightOfASheet) {
  Scene scene;
  scene.garments = {square_garment(0.2, 0.02, 0.105)};
  Cloth sheet = build_cloth(scene);
  const BodyField ball = make_body_field({SphereBody{Vec3::Zero(), 0.1}, 0.3}, 0.02);
  SimulationScene simulated;
  simulated.body = &ball;
  simulated.body_friction = 0.3;
  simulated.options.rest_kinetic_energy = 1e-14;
  simulated.options.rest_residual = 1e-5;
  simulated.options.newton_tolerance = 1e-8;
  simulated.options.simulated_time_limit = 8;
  const Simulation result = simulate(sheet, simulated, kGoOn);
  Vec3 carried = Vec3::Zero();
  double weight = 0;
  for (double m : result.mass) weight += kGravity * m;
  for (const Contact& c : result.contacts) {
    const Vec3 force = contact_response(c, simulated.options.contact_stiffness, contact_point(c, sheet.x)).force;
    for (int i = 0; i < c.count; ++i) carried += c.weights[i] * force;
  }
  const Vec3 error = (carried - Vec3(0, weight, 0)) / weight;
  std::cout << "contact forces of a sheet on a sphere (" << result.stop_reason << " after " << result.time
            << " s): reference " << weight << " N, ours " << carried.y() << ", error over weight " << error.norm()
            << '\n';
  EXPECT_LT(error.norm(), 1e-4);
}
