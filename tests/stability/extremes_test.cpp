// Input at the edge of sense. What is asked: no crash, no endless run, no NaN; a drape that calls itself converged is
// sound; one that is not says why. Where physics leaves no doubt, the drape must converge.

#include "engine/drape.h"
#include "engine/quality/distance_between.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace toile {
namespace {

using namespace test;

constexpr double kRadius = 0.05;         ///< [m]
constexpr double kEarlyStopCost = 2e-3;  ///< mean distance to the drape that ran on [m]

struct Extreme {
  std::string name;
  void (*change)(Scene&);
  bool must_converge = true;
  bool may_cross = false;  ///< torn so far that distances reach the doubles' resolution; must then be told
};

void PrintTo(const Extreme& extreme, std::ostream* out) { *out << extreme.name; }

/// A square of 100 mm on a ball of 50 mm radius.
Scene patch_on_ball() {
  Scene scene;
  scene.garments = {square_garment(0.1, 0.01, kRadius + 4e-3)};
  scene.garments[0].fabric.bending_damping = 0.05;
  scene.body = Body{SphereBody{Vec3::Zero(), kRadius}, 0.3};
  scene.solver.simulated_time_limit = 2.0;
  return scene;
}

void scale_stretch(Scene& scene, double factor) {
  Fabric& f = scene.garments[0].fabric;
  f.stretch_stiffness = {f.stretch_stiffness.warp * factor, f.stretch_stiffness.weft * factor,
                         f.stretch_stiffness.bias * factor};
  f.poisson_stiffness *= factor;
}

void scale_bending(Scene& scene, double factor) {
  Fabric& f = scene.garments[0].fabric;
  f.bending_stiffness = {f.bending_stiffness.warp * factor, f.bending_stiffness.weft * factor,
                         f.bending_stiffness.bias * factor};
}

void replace_square(Scene& scene, double side, double edge_length, double height) {
  const Fabric fabric = scene.garments[0].fabric;
  scene.garments[0] = square_garment(side, edge_length, height, fabric);
}

const Extreme kExtremes[] = {
    {"Ordinary", [](Scene&) {}},
    {"StretchStiffnessTimesThousand",
     [](Scene& s) {
       scale_stretch(s, 1e3);
       s.solver.simulated_time_limit = 0.3;
     },
     false},
    {"StretchStiffnessTimesMillion",
     [](Scene& s) {
       scale_stretch(s, 1e6);
       s.solver.simulated_time_limit = 0.02;
     },
     false},
    {"StretchStiffnessOverHundred", [](Scene& s) { scale_stretch(s, 1e-2); }, false},
    {"DirectionsAThousandfoldApart",
     [](Scene& s) {
       s.garments[0].fabric.stretch_stiffness = {5e4, 50, 5};
       s.garments[0].fabric.poisson_stiffness = 10;
     },
     false},
    {"AreaDensityOfOneGram", [](Scene& s) { s.garments[0].fabric.area_density = 1e-3; }, false},
    {"AreaDensityOfTenKilograms", [](Scene& s) { s.garments[0].fabric.area_density = 10; }, false},
    {"NoBending", [](Scene& s) { scale_bending(s, 0); }, false},
    {"BendingTimesTenThousand", [](Scene& s) { scale_bending(s, 1e4); }, false},
    {"NoDamping", [](Scene& s) { s.garments[0].fabric.membrane_damping = s.garments[0].fabric.bending_damping = 0; },
     false},
    {"HugeDamping",
     [](Scene& s) {
       s.garments[0].fabric.membrane_damping = 10;
       s.garments[0].fabric.bending_damping = 100;
     },
     false},
    {"NoFriction", [](Scene& s) { s.body->friction = s.garments[0].fabric.friction_cloth = 0; }, false},
    {"FrictionOfFive", [](Scene& s) { s.body->friction = s.garments[0].fabric.friction_cloth = 5; }},
    {"TimeStepOfTenMilliseconds", [](Scene& s) { s.solver.max_time_step = 1e-2; }, false},
    {"TimeStepOfATenthOfAMillisecond",
     [](Scene& s) {
       s.solver.max_time_step = 1e-4;
       s.solver.simulated_time_limit = 0.2;
     },
     false},
    {"EdgesOfTwoMillimetres", [](Scene& s) { replace_square(s, 0.02, 2e-3, kRadius + 2e-3); }},
    {"EdgesAsLongAsTheCloth", [](Scene& s) { replace_square(s, 0.1, 0.1, kRadius + 4e-3); }, false},
    {"ASpeckOfCloth", [](Scene& s) { replace_square(s, 2e-3, 1e-3, kRadius + 1e-3); }, false},
    {"AThicknessOfTwentyMillimetres", [](Scene& s) { s.garments[0].fabric.thickness = 0.02; }, false},
    {"AContactDistanceOfTenMillimetres", [](Scene& s) { s.solver.contact_distance = 1e-2; }, false},
    {"ContactStiffnessTimesThousand",
     [](Scene& s) {
       s.solver.contact_stiffness = 1e5;
       s.solver.simulated_time_limit = 0.5;
     },
     false},
    {"ContactStiffnessOverThousand", [](Scene& s) { s.solver.contact_stiffness = 0.1; }, false},
    {"NoRelaxation", [](Scene& s) { s.solver.relaxation_time = 0; }},
    {"NoAirDrag", [](Scene& s) { s.solver.air_drag = 0; }, false},
    {"StartsHalfInsideTheBall", [](Scene& s) { replace_square(s, 0.1, 0.01, 0.02); }, false},
    {"StartsStretchedByAHalf",
     [](Scene& s) {
       GarmentMesh shape;
       shape.mesh = surface_mesh(build_cloth(s));
       for (auto& corners : shape.mesh.corner_uv)
         for (Vec2& uv : corners) uv /= 1.5;
       s.garments[0].shape = shape;
     }},
    {"StartsSqueezedByAHalf",
     [](Scene& s) {
       GarmentMesh shape;
       shape.mesh = surface_mesh(build_cloth(s));
       for (auto& corners : shape.mesh.corner_uv)
         for (Vec2& uv : corners) uv *= 2;
       s.garments[0].shape = shape;
     },
     false},
    {"FarFromTheOrigin",
     [](Scene& s) {
       s.body = Body{SphereBody{Vec3(1000, 0, 0), kRadius}, 0.3};
       std::get<Pattern>(s.garments[0].shape).panels[0].translation.x() += 1000;
     }},
    {"PulledByAPinFasterThanSound",
     [](Scene& s) {
       PinMoved jerk;
       jerk.key_frames = {{0.2, Vec3::Zero(), Vec3::Zero()}, {0.201, Vec3(0, 0.5, 0), Vec3::Zero()}};
       s.garments[0].pins = {{PinNearest{Vec3(0, 1, 0)}, jerk}};
       s.solver.simulated_time_limit = 0.2003;
     },
     false, true},
    {"PinsFartherApartThanTheClothIsLong",
     [](Scene& s) {
       PinMoved pull;
       pull.key_frames = {{0.1, Vec3::Zero(), Vec3::Zero()}, {0.4, Vec3(0.15, 0, 0), Vec3::Zero()}};
       s.garments[0].pins = {{PinEdge{0, 1}, pull}, {PinEdge{0, 3}, PinFixed{}}};
       s.solver.simulated_time_limit = 0.6;
     },
     false},
};

bool warns(const Report& report, const std::string& words) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

class Extremes : public ::testing::TestWithParam<Extreme> {};

TEST_P(Extremes, IsAGoodDrapeOrSaysWhyNot) {
  Scene scene = patch_on_ball();
  GetParam().change(scene);
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  const Report& r = result.report;
  std::cout << "[ " << r.status << " ] " << r.stop_reason << " after " << r.simulated_time << " s, " << r.steps
            << " steps, " << r.splits << " splits, penetration " << 1e3 * r.penetration_max << " mm, "
            << r.self_intersections << " crossings, stretch " << 100 * std::max(r.stretch_warp.p99, r.stretch_weft.p99)
            << " %, residual " << r.residual_rms << ", " << r.time.total << " s\n";

  EXPECT_TRUE(all_finite(result.cloth.x));
  for (const Vec3& p : result.cloth.x) EXPECT_LT((p - result.cloth.x[0]).norm(), 1.0) << "torn apart";
  for (double value :
       {r.stretch_warp.mean, r.stretch_warp.p99, r.stretch_warp.max, r.stretch_weft.mean, r.stretch_weft.p99,
        r.stretch_weft.max, r.residual_rms, r.residual_max, r.penetration_max, r.kinetic_energy, r.simulated_time})
    EXPECT_TRUE(std::isfinite(value));
  for (double force : result.contact_force) EXPECT_TRUE(std::isfinite(force));
  EXPECT_EQ(warns(r, "passes through itself"), r.self_intersections > 0);
  if (!GetParam().may_cross || r.status == "converged") {
    EXPECT_EQ(r.self_intersections, 0) << "cloth never passes through cloth";
  }
  if (r.status == "converged") {
    EXPECT_EQ(r.stop_reason, "at_rest");
    EXPECT_LE(r.simulated_time, scene.solver.simulated_time_limit + scene.solver.max_time_step);
    EXPECT_EQ(warns(r, "forces do not balance"), r.residual_rms > 0.1);
    EXPECT_EQ(warns(r, "inside the body"), r.penetration_max > 2e-3);
  } else {
    EXPECT_EQ(r.status, "not_converged");
    EXPECT_TRUE(r.stop_reason == "time_limit" || r.stop_reason == "step_too_small") << r.stop_reason;
  }
  if (!GetParam().must_converge) return;
  EXPECT_EQ(r.status, "converged");
  EXPECT_LT(r.penetration_max, 2e-3);
  EXPECT_LT(std::max(r.stretch_warp.p99, r.stretch_weft.p99), 0.05);

  // What stopping early costs, against the same drape at the time limit.
  scene.solver.early_stop = false;
  const Drape whole = drape(scene, monitor);
  EXPECT_EQ(whole.report.status, "converged");
  const DrapeDistance cost = vertex_distance(result.cloth.x, whole.cloth.x);
  std::cout << "stopping early cost " << 1e3 * cost.mean << " mm in the mean, " << 1e3 * cost.max
            << " mm at most; residual " << r.residual_rms << " against " << whole.report.residual_rms << "\n";
  EXPECT_LT(cost.mean, kEarlyStopCost);
}

INSTANTIATE_TEST_SUITE_P(Scene, Extremes, ::testing::ValuesIn(kExtremes),
                         [](const auto& extreme) { return extreme.param.name; });

}  // namespace
}  // namespace toile
