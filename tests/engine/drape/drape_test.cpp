// The whole engine on scenes of a few hundred vertices.

#include "engine/drape.h"

#include "engine/parallel/state_hash.h"
#include "engine/scene/problem.h"
#include "tests/engine/drape/meshes.h"
#include "tests/engine/drape/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace toile {
namespace {

using namespace test;

bool warns(const Report& report, const std::string& words) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

/// What a reader of any report may rely on.
void expect_consistent(const Drape& drape, const Scene& scene) {
  const Report& r = drape.report;
  EXPECT_EQ(r.vertices, static_cast<long>(drape.cloth.x.size()));
  EXPECT_EQ(r.triangles, static_cast<long>(drape.cloth.triangles.size()));
  EXPECT_EQ(drape.contact_force.size(), drape.cloth.x.size());
  EXPECT_EQ(drape.stretch_warp.size(), drape.cloth.triangles.size());
  EXPECT_EQ(drape.stretch_weft.size(), drape.cloth.triangles.size());
  EXPECT_TRUE(all_finite(drape.cloth.x));
  EXPECT_EQ(r.result_sha256, sha256_hex(drape.cloth.x));
  EXPECT_EQ(r.self_intersections, static_cast<long>(self_intersections(drape.cloth.x, drape.cloth.triangles).size()));
  EXPECT_EQ(drape.body_mesh.triangles.empty(), !scene.body.has_value());
  for (const StretchStatistics& s : {r.stretch_warp, r.stretch_weft}) {
    EXPECT_LE(s.p99, s.max);
    EXPECT_LE(s.mean, s.max);
  }
  for (std::size_t t = 0; t < drape.stretch_warp.size(); ++t) {
    EXPECT_LE(drape.stretch_warp[t], r.stretch_warp.max + 1e-12);
    EXPECT_LE(drape.stretch_weft[t], r.stretch_weft.max + 1e-12);
  }
  for (const StretchStatistics& s : {r.stretch_warp, r.stretch_weft, r.stretch_bias}) {
    EXPECT_LE(s.min, s.p01);
    EXPECT_LE(s.p01, s.median);
    EXPECT_LE(s.median, s.p99);
  }
  EXPECT_LE(r.contacts.body_sticking, r.contacts.body);
  EXPECT_LE(r.contacts.cloth_sticking, r.contacts.cloth);
  if (r.status != "failed") {
    EXPECT_GE(r.discretisation_error, 0);
    EXPECT_GE(r.energies.size(), 4u);
  }
  EXPECT_GE(r.residual_max, r.residual_rms);
  if (r.stop_reason == "at_rest" && scene.fidelity != Fidelity::preview && scene.solver.rest_residual > 0) {
    EXPECT_LT(r.residual_rms, scene.solver.rest_residual) << "said to be in balance";
  }
  EXPECT_GE(r.kinetic_energy, 0);
  const StageTimes& t = r.time;
  for (double part : {t.assemble, t.collisions, t.derivatives, t.assembly, t.linear_solve, t.line_search, t.other})
    EXPECT_GE(part, 0);
  EXPECT_LE(t.collisions + t.derivatives + t.assembly + t.linear_solve + t.line_search + t.other, t.drape + 1e-3);
  EXPECT_LE(t.assemble + t.drape, t.total + 1e-3);
}

TEST(Drape, ASkirtOnACylinderConvergesAndReportsWhatItIsWorth) {
  const Scene scene = skirt_scene();
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  const Report& r = result.report;
  EXPECT_EQ(r.status, "converged");
  EXPECT_EQ(r.stop_reason, "at_rest");
  EXPECT_LT(r.seam_gap_max, 1e-3);
  EXPECT_EQ(r.self_intersections, 0);
  EXPECT_LT(r.penetration_max, 2e-3);
  EXPECT_LT(r.stretch_warp.p99, 0.05);
  EXPECT_LT(r.stretch_weft.p99, 0.05);
  EXPECT_GT(r.steps, 100);
  EXPECT_GE(r.newton_iterations, r.steps);
  EXPECT_GT(r.cg_iterations, 0);
  EXPECT_NEAR(r.simulated_time, scene.solver.max_time_step * static_cast<double>(r.steps), 0.5 * r.simulated_time);
  EXPECT_TRUE(result.cloth.seam_pairs.empty());
}

TEST(Drape, TellsItsStagesInOrderAndAFractionThatRises) {
  CountingMonitor monitor;
  drape(skirt_scene(), monitor);
  EXPECT_EQ(monitor.stages, (std::vector<std::string>{"mesh", "body", "assemble", "relax", "drape", "measure"}));
  EXPECT_TRUE(monitor.rising);
  EXPECT_GT(monitor.last.fraction_done, 0.9);
}

TEST(Drape, SameBytesOnAnyNumberOfThreadsAndInEveryRun) {
  const auto hash = [](int threads) {
    Scene scene = skirt_scene();
    scene.solver.threads = threads;
    scene.solver.simulated_time_limit = 0.3;
    CountingMonitor monitor;
    return drape(scene, monitor).report.result_sha256;
  };
  const std::string one = hash(1);
  EXPECT_EQ(one.size(), 64u);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(0));
}

TEST(Drape, CancelsInEveryStage) {
  CountingMonitor whole;
  Scene scene = skirt_scene();
  scene.solver.simulated_time_limit = 0.1;
  drape(scene, whole);
  for (long at : {0L, 1L, 2L, 10L, whole.count / 2, whole.count - 1}) {
    CountingMonitor monitor(at);
    EXPECT_THROW(drape(scene, monitor), Cancelled) << at;
    EXPECT_EQ(monitor.count, at + 1);
  }
}

TEST(Drape, PreviewIsQuickSoundAndSaysThatItIsOne) {
  Scene scene = ball_scene();
  scene.fidelity = Fidelity::preview;
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_TRUE(result.report.status == "converged" || result.report.status == "not_converged");
  EXPECT_EQ(result.report.self_intersections, 0);
  EXPECT_LT(result.report.penetration_max, 2e-3);
  EXPECT_EQ(result.report.newton_iterations, 0);
  EXPECT_TRUE(warns(result.report, "preview"));
}

TEST(Drape, ADrapeThatIsCutShortHasNotConverged) {
  Scene scene = ball_scene();
  scene.solver.simulated_time_limit = 0.15;
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.status, "not_converged");
  EXPECT_EQ(result.report.stop_reason, "time_limit");
}

TEST(Drape, AStepThatCannotSucceedHasNotConverged) {
  Scene scene = ball_scene();
  scene.solver.newton_tolerance = 1e-30;
  scene.solver.newton_iterations = 1;
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.status, "not_converged");
  EXPECT_EQ(result.report.stop_reason, "step_too_small");
}

TEST(Drape, SeamsThatDoNotCloseFailByName) {
  Scene scene;
  scene.garments = {garment_of(tube_pattern(0.2, 0.1, 0.16, -0.05), 0.05)};
  scene.body = cylinder_body();
  scene.garments[0].pins = {{PinEdge{0, 1}, PinFixed{}}, {PinEdge{1, 3}, PinFixed{}}};
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.status, "failed");
  EXPECT_EQ(result.report.stop_reason, "seams_open");
  EXPECT_GT(result.report.seam_gap_max, 0.1);
  EXPECT_TRUE(warns(result.report, "front"));
}

TEST(Drape, RefusesWhatTheSceneCheckRefuses) {
  Scene scene = ball_scene();
  scene.garments[0].fabric.area_density = std::nan("");
  CountingMonitor monitor;
  EXPECT_THROW(drape(scene, monitor), InputError);
  scene = {};
  EXPECT_THROW(drape(scene, monitor), InputError);
}

TEST(Drape, RefusesAPinOnAVertexThatIsNotThere) {
  for (Scene scene : {ball_scene(), skirt_scene()}) {
    scene.garments[0].pins = {{PinVertices{{1000000}}, PinFixed{}}};
    CountingMonitor monitor;
    EXPECT_THROW(drape(scene, monitor), InputError);
  }
}

TEST(Drape, RefusesAGarmentInsideAHugeBody) {
  for (Scene scene : {ball_scene(), skirt_scene()}) {
    scene.body = Body{SphereBody{Vec3::Zero(), 2.0}, 0.3};
    CountingMonitor monitor;
    try {
      drape(scene, monitor);
      ADD_FAILURE() << "no InputError";
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems()[0].code, "panel_inside_body");
    }
  }
}

/// The skirt as if its unit were `scale` times the one that its document names.
Scene misread_skirt(double scale) {
  Scene scene = skirt_scene();
  Pattern& pattern = std::get<Pattern>(scene.garments[0].shape);
  for (Panel& panel : pattern.panels) {
    for (Vec2& v : panel.vertices) v *= scale;
    panel.translation *= scale;
  }
  scene.garments[0].edge_length = std::clamp(scene.garments[0].edge_length * scale, 0.003, 0.1);
  return scene;
}

std::vector<Problem> problems_of(const Scene& scene) {
  CountingMonitor monitor;
  try {
    drape(scene, monitor);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

TEST(Drape, RefusesAPatternReadInAMuchTooLargeUnitByItsSize) {
  const std::vector<Problem> problems = problems_of(misread_skirt(20));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].code, "implausible_size");
  EXPECT_EQ(problems[0].pointer, "/garments/0");
  EXPECT_NE(problems[0].detail.find("6.9 m long"), std::string::npos) << problems[0].detail;
}

TEST(Drape, AClothMuchLargerThanASmallBodyIsWarnedOfAndSewn) {
  Scene scene = ball_scene();
  Panel half = rectangle_panel("half", 0.25, 0.5);
  half.rotation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()).toRotationMatrix();
  half.translation = Vec3(-0.126, 0.105, 0.25);
  Panel other = half;
  other.name = "other";
  other.translation.x() = 0.126;
  scene.garments[0].shape = Pattern{{half, other}, {{{0, 1}, {1, 3}, false}}};
  scene.garments[0].edge_length = 0.05;
  CountingMonitor monitor;
  const Report report = drape(scene, monitor).report;
  EXPECT_EQ(report.status, "converged");
  EXPECT_TRUE(warns(report, "implausible_size: panel 'half' is 0.5 m long and the body 0.20 m"));
}

TEST(Drape, AMeshOfAnotherSizeThanItsFlatPatternIsWarnedOfOrRefused) {
  const auto scene_with = [](double uv_unit) {
    Scene scene = ball_scene(0.03);
    GarmentMesh shape;
    shape.mesh = surface_mesh(build_cloth(scene));
    shape.uv_unit = uv_unit;
    scene.garments[0].shape = std::move(shape);
    scene.solver.simulated_time_limit = 0.02;
    return scene;
  };
  CountingMonitor monitor;
  EXPECT_FALSE(warns(drape(scene_with(1), monitor).report, "implausible_uv_unit"));
  EXPECT_TRUE(warns(drape(scene_with(2), monitor).report, "0.5 times as large in space"));
  const std::vector<Problem> problems = problems_of(scene_with(1000));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].code, "implausible_uv_unit");
  EXPECT_EQ(problems[0].pointer, "/garments/0/mesh");
}

TEST(Drape, AGarmentFarFromItsBodyIsWarnedOf) {
  Scene scene = ball_scene(0.03);
  scene.body = Body{SphereBody{Vec3(0, 3, 0), 0.1}, 0.3};
  scene.solver.simulated_time_limit = 0.02;
  CountingMonitor monitor;
  EXPECT_TRUE(warns(drape(scene, monitor).report, "far from the body: garment 0"));
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}};
  EXPECT_FALSE(warns(drape(scene, monitor).report, "far from the body"));
}

TEST(Drape, PanelsThatTouchAsDrawnComeApart) {
  Scene scene = zipped_halves(0.1, 0.2, 0.2, 0, 0);
  scene.garments[0].edge_length = 0.03;
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}, {PinEdge{1, 2}, PinFixed{}}};
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  EXPECT_EQ(result.report.status, "converged");
  EXPECT_EQ(result.report.self_intersections, 0);
  EXPECT_LT(result.report.stretch_weft.max, 0.01);
}

TEST(Drape, LayersInTheSamePlaceAreRefused) {
  Scene scene = ball_scene(0.03);
  scene.garments.push_back(scene.garments[0]);
  const std::vector<Problem> problems = problems_of(scene);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].code, "coincident_layers");
  Scene sewn = skirt_scene();
  sewn.garments.push_back(scene.garments[0]);
  sewn.garments.push_back(scene.garments[0]);
  const std::vector<Problem> beside_sewn = problems_of(sewn);
  ASSERT_EQ(beside_sewn.size(), 1U);
  EXPECT_EQ(beside_sewn[0].code, "panel_inside_body");  // where panels are moved clear of one another, by that
  EXPECT_EQ(beside_sewn[0].pointer, "/garments/2");
}

TEST(Drape, OfATinyPatternItsSizeIsSaid) {
  CountingMonitor monitor;
  const Report report = drape(misread_skirt(0.1), monitor).report;
  EXPECT_TRUE(warns(report, "implausible_size: garment 0 is 0.0"));
}

TEST(Drape, RefusesEdgesThatLeaveNothingOfAGarment) {
  // Two triangles a panel, and those of the back lie on those of the front.
  Panel front = rectangle_panel("front", 0.04, 0.04), back = front;
  back.name = "back";
  front.translation.z() = 0.31;
  back.translation.z() = 0.3;
  for (int k = 0; k < 4; ++k) back.edges[k] = {(4 - k) % 4, 3 - k, StraightEdge{}, ""};
  Scene scene = skirt_scene();
  scene.garments.push_back(
      garment_of(Pattern{{front, back}, {{{0, 1}, {1, 2}, false}, {{0, 3}, {1, 0}, false}}}, 0.04, "tiny"));
  const std::vector<Problem> problems = problems_of(scene);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].code, "empty_garment");
  EXPECT_EQ(problems[0].pointer, "/garments/1");
}

TEST(Drape, WhatRestsOnTheWrongSideOfTheBodyIsNotConverged) {
  Scene scene;
  scene.garments = {square_garment(0.2, 0.02, 0)};
  scene.garments[0].pins = {{PinBox{Vec3(-1, -1, -1), Vec3(1, 1, 1)}, PinFixed{}}};
  scene.body = Body{BoxBody{Vec3::Zero(), Vec3(0.05, 0.15, 0.05), Mat3::Identity()}, 0.3};
  CountingMonitor monitor;
  const Report report = drape(scene, monitor).report;
  EXPECT_GT(report.penetration_max, 0.03);
  EXPECT_EQ(report.status, "not_converged");
  EXPECT_EQ(report.stop_reason, "inside_body");
}

TEST(Drape, TinyPanelsInsideTheBodyAreRefusedForBothReasons) {
  Scene scene = misread_skirt(0.1);
  scene.body = Body{SphereBody{Vec3::Zero(), 2.0}, 0.3};
  const std::vector<Problem> problems = problems_of(scene);
  ASSERT_GE(problems.size(), 2U);
  EXPECT_EQ(problems[0].code, "panel_inside_body");
  for (std::size_t p = 1; p < problems.size(); ++p) {
    EXPECT_EQ(problems[p].code, "implausible_size");
    EXPECT_EQ(problems[p].pointer, "/garments");
    EXPECT_NE(problems[p].detail.find("are its units right?"), std::string::npos) << problems[p].detail;
  }
}

TEST(Drape, ABodyWithAHoleCarriesTheClothAndIsToldOf) {
  Scene scene = ball_scene();
  scene.body = Body{MeshBody{ball_mesh(0.1, 16, 32)}, 0.3};
  auto& triangles = std::get<MeshBody>(scene.body->shape).mesh.triangles;
  triangles.erase(triangles.begin() + 300, triangles.begin() + 304);
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.status, "converged");
  EXPECT_LT(result.report.penetration_max, 2e-3);
  EXPECT_EQ(result.report.self_intersections, 0);
  EXPECT_FALSE(result.report.warnings.empty()) << "the hole is not told of";
}

TEST(Drape, AGarmentMeshIsSewnAlongItsPairs) {
  Scene scene;
  scene.body = cylinder_body();
  scene.garments = {garment_of({}, 0.03)};
  scene.garments[0].shape = tube_mesh(0.345, 0.12, 0.14, 12, 4);
  const auto& shape = std::get<GarmentMesh>(scene.garments[0].shape);
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.vertices, static_cast<long>(shape.mesh.vertices.size() - shape.seams.size()));
  EXPECT_EQ(boundary_loops(result.cloth.triangles).size(), 2u);
  EXPECT_LT(result.report.seam_gap_max, 1e-3);
  EXPECT_EQ(result.report.self_intersections, 0);
  EXPECT_LT(result.report.penetration_max, 2e-3);
}

TEST(Drape, TwoGarmentsStayInLayerOrder) {
  Scene scene = skirt_scene();
  scene.garments.push_back(scene.garments[0]);
  Pattern outer_skirt = tube_pattern(0.37, 0.12, 0.19, -0.06);
  for (Panel& panel : outer_skirt.panels) panel.edges[2].label = "lower_interface";
  scene.garments[1].shape = outer_skirt;
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.self_intersections, 0);
  double inner = 0, outer = 0, n_inner = 0, n_outer = 0;
  for (std::size_t v = 0; v < result.cloth.x.size(); ++v) {
    const bool is_outer = result.cloth.vertex_garment[v] == 1;
    (is_outer ? outer : inner) += radius_of(result.cloth.x[v]);
    ++(is_outer ? n_outer : n_inner);
  }
  EXPECT_GT(outer / n_outer, inner / n_inner);
}

TEST(Drape, WithoutABodyAPinnedClothHangs) {
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("banner", 0.15, 0.2)}, {}}, 0.02)};
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}};
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  expect_consistent(result, scene);
  EXPECT_EQ(result.report.status, "converged");
  EXPECT_EQ(result.report.penetration_max, 0);
  const StageTimes& time = result.report.time;
  EXPECT_GT(time.other, 0);
  EXPECT_LE(time.collisions + time.derivatives + time.assembly + time.linear_solve + time.line_search + time.other,
            time.drape);
  EXPECT_LT(result.report.residual_rms, 0.05);
  EXPECT_EQ(result.report.limited_vertices, 0);
}

TEST(Drape, AnEmptyWarningListMeansNothingToSay) {
  Scene scene = ball_scene(0.015);
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  EXPECT_EQ(result.report.status, "converged");
  for (const std::string& warning : result.report.warnings) ADD_FAILURE() << warning;
  // The ball carries the weight.
  const double weight = kGravity * scene.garments[0].fabric.area_density * 0.2 * 0.2;
  EXPECT_GT(std::accumulate(result.contact_force.begin(), result.contact_force.end(), 0.0), 0.9 * weight);
}

TEST(Drape, OverstretchedWovenClothIsWarnedOf) {
  Scene scene;
  scene.garments = {garment_of(Pattern{{rectangle_panel("banner", 0.1, 0.2)}, {}}, 0.02)};
  scene.garments[0].fabric.stretch_stiffness = {4, 4, 2};  // 10 % at the top under its own weight
  scene.garments[0].fabric.poisson_stiffness = 0;
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}};
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  EXPECT_GT(result.report.stretch_warp.p99, 0.05);
  EXPECT_TRUE(warns(result.report, "over-stretched"));
}

}  // namespace
}  // namespace toile
