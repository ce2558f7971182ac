// The judge of any mesh, on drapes of our own and on what is made of them.

#include "engine/check.h"

#include "engine/drape.h"
#include "engine/mesh/build_cloth.h"
#include "engine/mesh/gltf.h"
#include "engine/mesh/obj.h"
#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"
#include "tests/engine/drape/meshes.h"
#include "tests/engine/drape/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace toile {
namespace {

using namespace test;

/// A sheet that leaves a wall level, and sags.
Scene shelf_scene() {
  Scene scene;
  scene.garments = {square_garment(0.1, 0.01, 0, isotropic_fabric(0.2, 1500, 200, 200, 5e-5))};
  scene.garments[0].pins = {{PinEdge{0, 0}, PinFixed{}, true}};
  return scene;
}

Drape draped(const Scene& scene) {
  CountingMonitor monitor;
  return drape(scene, monitor);
}

double energy(const Report& report, const std::string& term) {
  for (const TermEnergy& e : report.energies)
    if (e.term == term) return e.energy;
  ADD_FAILURE() << "no energy of " << term;
  return 0;
}

void expect_same(const StretchStatistics& a, const StretchStatistics& b) {
  for (double StretchStatistics::*member :
       {&StretchStatistics::mean, &StretchStatistics::min, &StretchStatistics::p01, &StretchStatistics::median,
        &StretchStatistics::p99, &StretchStatistics::max})
    EXPECT_DOUBLE_EQ(a.*member, b.*member);
}

TEST(Judge, AgreesWithTheReportOfOurOwnDrape) {
  for (const Scene& scene : {ball_scene(), skirt_scene()}) {
    const Drape ours = draped(scene);
    const Report &said = ours.report, judged = judge(scene, surface_mesh(ours.cloth));
    EXPECT_EQ(judged.status, "converged");
    EXPECT_EQ(judged.stop_reason, "checked");
    EXPECT_EQ(judged.result_sha256, said.result_sha256);
    EXPECT_EQ(judged.vertices, said.vertices);
    expect_same(judged.stretch_warp, said.stretch_warp);
    expect_same(judged.stretch_weft, said.stretch_weft);
    expect_same(judged.stretch_bias, said.stretch_bias);
    EXPECT_DOUBLE_EQ(judged.penetration_max, said.penetration_max);
    EXPECT_EQ(judged.self_intersections, said.self_intersections);
    EXPECT_DOUBLE_EQ(judged.discretisation_error, said.discretisation_error);
    for (const char* term : {"membrane", "bending", "gravity", "contact"})
      EXPECT_DOUBLE_EQ(energy(judged, term), energy(said, term)) << term;
    // Forces that contacts might have can't leave more than those that they have.
    EXPECT_LT(judged.residual_rms, 1.001 * said.residual_rms);
    EXPECT_GT(judged.residual_rms, 0.1 * said.residual_rms);
    if (scene.garments[0].pins.empty()) {  // the ball carries the sheet, pins the skirt
      EXPECT_GT(energy(said, "friction"), 0);
      EXPECT_GT(said.contacts.body_sticking, 0);
      EXPECT_GT(judged.contacts.body, 0);
      EXPECT_GT(judged.contacts.body_sticking, 0);
    }
  }
}

TEST(Judge, CountsWhatClampsHold) {
  Scene scene = shelf_scene();
  const Drape ours = draped(scene);
  const TriangleMesh mesh = surface_mesh(ours.cloth);
  const Report judged = judge(scene, mesh);
  EXPECT_EQ(judged.status, "converged");
  EXPECT_DOUBLE_EQ(energy(judged, "bending"), energy(ours.report, "bending"));
  EXPECT_NEAR(judged.residual_rms, ours.report.residual_rms, 1e-3 * ours.report.residual_rms);
  scene.garments[0].pins[0].clamp = false;
  EXPECT_GT(judge(scene, mesh).residual_rms, 10 * judged.residual_rms) << "a hinge doesn't hold it";
}

/// A sheet that rubs as it bends rests wherever friction lets it: as it came down from level, and where it would hang
/// without friction.
TEST(Judge, LetsTheFrictionOfBendingHoldWhatItMay) {
  Scene scene = shelf_scene();
  scene.solver.rest_residual = 5e-3;
  const Scene elastic = scene;
  scene.garments[0].fabric.bending_hysteresis = {4e-4, 4e-4, 4e-4};
  const Drape limp = draped(elastic), stiff = draped(scene);
  const TriangleMesh hanging = surface_mesh(limp.cloth), held = surface_mesh(stiff.cloth);
  const Report judged = judge(scene, held);
  EXPECT_EQ(judged.status, "converged");
  EXPECT_TRUE(judged.warnings.empty());
  EXPECT_LT(judged.residual_rms, stiff.report.residual_rms + 2e-3);
  EXPECT_GT(judge(elastic, held).residual_rms, 10 * stiff.report.residual_rms) << "friction holds it";
  EXPECT_LT(judge(scene, hanging).residual_rms, judge(elastic, hanging).residual_rms + 1e-9);
}

/// Limit analysis: what hangs in balance under twice its weight lacks just its weight, and friction can put as much of
/// it back as its moment at the wall allows. The sheet sags so little that next to nothing of its weight lies along it,
/// which is the membrane's to carry.
TEST(Judge, LetsTheFrictionOfBendingHoldNoMoreThanItMay) {
  Scene scene = shelf_scene();
  scene.solver.rest_residual = 5e-3;
  Fabric& fabric = scene.garments[0].fabric;
  fabric.bending_stiffness = {5e-2, 5e-2, 5e-2};
  fabric.area_density *= 2;
  const Cloth drawn = draped(scene).cloth;
  const TriangleMesh mesh = surface_mesh(drawn);
  fabric.area_density /= 2;
  EXPECT_NEAR(judge(scene, mesh).residual_rms, 1, 0.02);
  double moment = 0;  // of the weight about the wall, per width [N]
  for (std::size_t t = 0; t < drawn.triangles.size(); ++t) {
    const auto& f = drawn.flat[t];
    const Vec2 a = f[1] - f[0], b = f[2] - f[0];
    double off = 0;
    for (const int v : drawn.triangles[t]) off += (0.05 - drawn.x[static_cast<std::size_t>(v)].z()) / 3;
    moment += fabric.area_density * kGravity * 0.5 * std::abs(a.x() * b.y() - a.y() * b.x()) * off / 0.1;
  }
  const auto left_with = [&](double share) {
    const double loop = 2 * share * moment;  // friction's moment is half the loop's width
    fabric.bending_hysteresis = {loop, loop, loop};
    return judge(scene, mesh).residual_rms;
  };
  const double enough = left_with(1.2), less = left_with(0.8), half = left_with(0.5);
  std::cout << "left of a weight at 1.2, 0.8 and 0.5 of the moment that carries it: " << enough << ", " << less << ", "
            << half << '\n';
  EXPECT_LT(enough, 0.03);
  EXPECT_GT(less, 0.05);
  EXPECT_GT(half, 2 * less);
}

/// A mesh does not show the button that draws it down, but where it hangs follows from the mesh.
TEST(Judge, FindsWhereTrimsRest) {
  Scene scene = shelf_scene();
  Trim heavy;
  heavy.holes = {{"square", Vec2(0.01, 0.06)}};
  heavy.button.mass = 1e-3;
  heavy.friction = 0;
  scene.garments[0].trims = {heavy};
  scene.solver.rest_residual = 5e-3;
  const Drape ours = draped(scene);
  ASSERT_EQ(ours.report.status, "converged");
  const TriangleMesh mesh = surface_mesh(ours.cloth);
  const Report judged = judge(scene, mesh);
  EXPECT_NEAR(judged.residual_rms, ours.report.residual_rms, 5e-3);
  EXPECT_NEAR(energy(judged, "attachment"), energy(ours.report, "attachment"),
              0.02 * energy(ours.report, "attachment"));
  EXPECT_TRUE(judged.warnings.empty());
  scene.garments[0].trims[0].friction = 0.2;
  EXPECT_EQ(judge(scene, mesh).warnings.size(), 1u);
  scene.garments[0].trims.clear();
  EXPECT_GT(judge(scene, mesh).residual_rms, 1) << "something draws it down";
}

TEST(Judge, SeesThatAMeshIsNoEquilibrium) {
  const Scene scene = ball_scene();
  const Drape ours = draped(scene);
  TriangleMesh shaken = surface_mesh(ours.cloth);
  for (std::size_t v = 0; v < shaken.vertices.size(); ++v)
    shaken.vertices[v] += 1e-4 * Vec3(std::sin(7.0 * static_cast<double>(v)), std::sin(11.0 * static_cast<double>(v)),
                                      std::sin(13.0 * static_cast<double>(v)));
  const Report of_shaken = judge(scene, shaken);
  EXPECT_GT(of_shaken.residual_rms, 20 * ours.report.residual_rms);
  EXPECT_EQ(of_shaken.status, "not_converged");

  TriangleMesh lifted = surface_mesh(ours.cloth);
  for (Vec3& p : lifted.vertices) p.y() += 0.02;
  const Report of_lifted = judge(scene, lifted);
  EXPECT_EQ(of_lifted.contacts.body, 0);
  EXPECT_GT(of_lifted.residual_rms, 10 * ours.report.residual_rms) << "nothing carries it";
  EXPECT_EQ(of_lifted.status, "not_converged");
}

/// As another program would leave it, farther from the body than our contact reaches.
TEST(Judge, CountsClothAsTouchingFromWhereItIsTold) {
  const Scene scene = ball_scene();
  TriangleMesh higher = surface_mesh(draped(scene).cloth);
  for (Vec3& p : higher.vertices) p.y() += 0.002;
  EXPECT_GT(judge(scene, higher).residual_rms, 0.5);
  const Report leaning = judge(scene, higher, {0.005});
  EXPECT_LT(leaning.residual_rms, 0.15);
  EXPECT_GT(leaning.contacts.body, 0);
}

TEST(Judge, TakesTheMeshAsWrittenToAFile) {
  const Scene scene = skirt_scene();
  const Drape ours = draped(scene);
  const TriangleMesh mesh = surface_mesh(ours.cloth);
  const Report of_obj = judge(scene, read_obj(write_obj(mesh)));
  EXPECT_NEAR(of_obj.stretch_warp.max, ours.report.stretch_warp.max, 1e-6);
  EXPECT_LT(of_obj.residual_rms, 2 * ours.report.residual_rms);
  EXPECT_EQ(of_obj.seam_gap_max, 0);
  const Report of_glb = judge(scene, read_glb(write_glb(mesh, &ours.body_mesh)));
  EXPECT_EQ(of_glb.vertices, ours.report.vertices);
  EXPECT_NEAR(of_glb.stretch_warp.max, ours.report.stretch_warp.max, 1e-4);
}

TEST(Judge, MeasuresTheSeamsOfAMeshThatIsNotSewn) {
  const Scene scene = skirt_scene();
  const Drape ours = draped(scene);
  const Cloth apart = build_cloth(scene);
  Cloth sewn = apart;
  const std::vector<int> sewn_vertex = merge_seams(sewn);
  TriangleMesh mesh = surface_mesh(apart);
  for (std::size_t v = 0; v < sewn_vertex.size(); ++v) mesh.vertices[v] = ours.cloth.x[sewn_vertex[v]];
  const Report closed = judge(scene, mesh);
  EXPECT_EQ(closed.seam_gap_max, 0);
  EXPECT_EQ(closed.result_sha256, ours.report.result_sha256);
  EXPECT_EQ(closed.status, "converged");
  mesh.vertices[apart.seam_pairs[0].a] += Vec3(0, 0.005, 0);
  const Report open = judge(scene, mesh);
  EXPECT_NEAR(open.seam_gap_max, 0.005, 1e-12);
  EXPECT_EQ(open.status, "not_converged");
}

TEST(Judge, TakesAGarmentMeshInItsOwnOrder) {
  Scene scene;
  scene.body = cylinder_body();
  scene.garments = {garment_of({}, 0.03)};
  scene.garments[0].shape = tube_mesh(0.345, 0.12, 0.14, 12, 4);
  TriangleMesh mesh = std::get<GarmentMesh>(scene.garments[0].shape).mesh;
  mesh.corner_uv.clear();
  std::swap(mesh.triangles.front(), mesh.triangles.back());
  const Report report = judge(scene, mesh);
  EXPECT_EQ(report.vertices, static_cast<long>(mesh.vertices.size()) - 10);
  EXPECT_NEAR(report.stretch_warp.max, 0, 1e-2);
  EXPECT_GT(report.seam_gap_max, 0.1) << "it is still flat";
}

TEST(Judge, RefusesAMeshOfAnotherGarment) {
  const Scene scene = ball_scene();
  TriangleMesh mesh = surface_mesh(build_cloth(scene));
  const auto code = [&](const TriangleMesh& given) {
    try {
      judge(scene, given);
    } catch (const InputError& error) {
      return error.problems()[0].code;
    }
    return std::string("none");
  };
  EXPECT_EQ(code(mesh), "none");
  TriangleMesh fewer = mesh;
  fewer.vertices.pop_back();
  fewer.triangles.clear();
  fewer.corner_uv.clear();
  EXPECT_EQ(code(fewer), "mesh_mismatch");
  TriangleMesh other = mesh;
  other.triangles[0] = {0, 1, static_cast<int>(mesh.vertices.size()) - 1};
  other.corner_uv[0] = {Vec2(9, 9), Vec2(8, 7), Vec2(5, 3)};
  EXPECT_EQ(code(other), "mesh_mismatch");
  TriangleMesh far = mesh;
  far.vertices[3] = Vec3(1e5, 0, 0);
  EXPECT_EQ(code(far), "mesh_out_of_range");
}

}  // namespace
}  // namespace toile
