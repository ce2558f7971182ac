#include "engine/scene/check.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

namespace toile {
namespace {

using testing::Contains;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Panel square(const std::string& name) {
  Panel panel;
  panel.name = name;
  panel.vertices = {{0, 0}, {0.3, 0}, {0.3, 0.4}, {0, 0.4}};
  for (int e = 0; e < 4; ++e) panel.edges.push_back({e, (e + 1) % 4, StraightEdge{}, ""});
  return panel;
}

Fabric poplin() {
  Fabric fabric;
  fabric.area_density = 0.12;
  fabric.stretch_stiffness = {2000, 1500, 100};
  fabric.poisson_stiffness = 200;
  fabric.bending_stiffness = {5e-6, 4e-6, 3e-6};
  fabric.thickness = 3e-4;
  return fabric;
}

Scene good_scene() {
  Pattern pattern;
  pattern.panels = {square("front"), square("back")};
  pattern.panels[0].edges[2].label = "lower_interface";
  pattern.stitches = {{{0, 1}, {1, 3}, false}, {{0, 3}, {1, 1}, false}};
  Scene scene;
  scene.garments.emplace_back();
  scene.garments[0].shape = pattern;
  scene.garments[0].fabric = poplin();
  scene.body = Body{SphereBody{Vec3::Zero(), 0.1}, 0.3};
  return scene;
}

Scene mesh_scene() {
  GarmentMesh shape;
  shape.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  shape.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  shape.mesh.corner_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}};
  Scene scene = good_scene();
  scene.garments[0].shape = shape;
  return scene;
}

std::vector<std::string> found(const Scene& scene) {
  std::vector<std::string> findings;
  for (const Problem& problem : scene_problems(scene)) {
    EXPECT_FALSE(problem.detail.empty());
    findings.push_back(problem.code + " " + problem.pointer);
  }
  return findings;
}

struct Case {
  std::string expected;
  std::function<void(Scene&)> spoil;
};

Pattern& pattern(Scene& scene) { return std::get<Pattern>(scene.garments[0].shape); }
GarmentMesh& mesh(Scene& scene) { return std::get<GarmentMesh>(scene.garments[0].shape); }

TEST(CheckScene, GoodScenesPass) {
  EXPECT_THAT(found(good_scene()), IsEmpty());
  EXPECT_THAT(found(mesh_scene()), IsEmpty());
  EXPECT_NO_THROW(check_scene(good_scene()));
}

TEST(CheckScene, NamesWhatIsWrongWithAPattern) {
  const std::string front = "/garments/0/pattern/panels/front";
  const std::vector<Case> cases = {
      {"empty_scene /garments", [](Scene& s) { s.garments.clear(); }},
      {"empty_garment /garments/0/pattern/panels", [](Scene& s) { pattern(s) = {}; }},
      {"not_finite " + front + "/vertices/2", [](Scene& s) { pattern(s).panels[0].vertices[2].y() = kNan; }},
      {"not_finite " + front + "/translation", [](Scene& s) { pattern(s).panels[0].translation.x() = kNan; }},
      {"not_finite " + front + "/rotation", [](Scene& s) { pattern(s).panels[0].rotation *= 2; }},
      {"not_finite " + front + "/edges/1/curvature",
       [](Scene& s) {
         pattern(s).panels[0].edges[1].curve = QuadraticEdge{{0.5, kNan}};
       }},
      {"open_panel_loop " + front + "/edges/3", [](Scene& s) { pattern(s).panels[0].edges[3].end = 1; }},
      {"vertex_out_of_range " + front + "/edges/3", [](Scene& s) { pattern(s).panels[0].edges[3].end = 9; }},
      {"too_few_edges " + front + "/edges", [](Scene& s) { pattern(s).panels[0].edges.resize(1); }},
      {"zero_length_edge " + front + "/edges/1",
       [](Scene& s) { pattern(s).panels[0].vertices[2] = pattern(s).panels[0].vertices[1]; }},
      {"zero_area_panel " + front,
       [](Scene& s) {
         pattern(s).panels[0].vertices = {{0, 0}, {0.3, 0}, {0.2, 0}, {0.1, 0}};
       }},
      {"self_crossing_panel " + front + "/edges/0", [](Scene& s) { pattern(s).panels[0].vertices[2].y() = -0.2; }},
      {"self_crossing_panel " + front + "/edges/0",  // its loops' areas cancel
       [](Scene& s) {
         pattern(s).panels[0].vertices = {{0, 0}, {0.3, 0.3}, {0.3, 0}, {0, 0.3}};
       }},
      {"self_crossing_panel " + front + "/edges/0",
       [](Scene& s) {
         pattern(s).panels[0].edges[0].curve = QuadraticEdge{{0.5, 5.0}};
       }},
      {"duplicate_panel " + front, [](Scene& s) { pattern(s).panels[1].name = "front"; }},
      {"edge_stitched_twice /garments/0/pattern/stitches/1", [](Scene& s) { pattern(s).stitches[1].a.edge = 1; }},
      {"stitch_missing_edge /garments/0/pattern/stitches/1/0", [](Scene& s) { pattern(s).stitches[1].a.edge = 7; }},
      {"stitch_missing_panel /garments/0/pattern/stitches/0/1", [](Scene& s) { pattern(s).stitches[0].b.panel = -1; }},
      {"edge_length_range /garments/0/edge_length_mm", [](Scene& s) { s.garments[0].edge_length = 0.0005; }},
      {"edge_length_range /garments/0/edge_length_mm", [](Scene& s) { s.garments[0].edge_length = kNan; }},
      {"too_many_vertices /garments/0",
       [](Scene& s) {
         for (Vec2& v : pattern(s).panels[0].vertices) v *= 20;
         s.garments[0].edge_length = 0.001;
       }},
      {"too_many_panels /garments/0/pattern/panels", [](Scene& s) { pattern(s).panels.resize(501, square("p")); }},
      {"unknown_panel /garments/0/panel_fabrics/a~1b", [](Scene& s) { s.garments[0].panel_fabrics["a/b"] = poplin(); }},
  };
  for (const Case& c : cases) {
    Scene scene = good_scene();
    c.spoil(scene);
    EXPECT_THAT(found(scene), Contains(c.expected));
    EXPECT_THROW(check_scene(scene), InputError);
  }
}

TEST(CheckScene, NamesWhatIsWrongWithAMesh) {
  const std::vector<Case> cases = {
      {"empty_garment", [](Scene& s) { mesh(s) = {}; }},
      {"not_finite", [](Scene& s) { mesh(s).mesh.vertices[1].z() = kNan; }},
      {"not_finite", [](Scene& s) { mesh(s).mesh.vertices[1].z() = 1e200; }},
      {"not_finite", [](Scene& s) { mesh(s).uv_unit = 0; }},
      {"collapsed_mesh",
       [](Scene& s) {
         for (Vec3& v : mesh(s).mesh.vertices) v = Vec3(1, 2, 3);
       }},
      {"vertex_out_of_range", [](Scene& s) { mesh(s).mesh.triangles[0][1] = 4; }},
      {"vertex_out_of_range",
       [](Scene& s) {
         mesh(s).seams = {{0, 17}};
       }},
      {"vertex_out_of_range",
       [](Scene& s) {
         mesh(s).mesh.stitches = {{0, 1, -2, 0.5}};
       }},
      {"missing_uv", [](Scene& s) { mesh(s).mesh.corner_uv.clear(); }},
      {"zero_area_triangle", [](Scene& s) { mesh(s).mesh.corner_uv[1][2] = Vec2(0.5, 0.5); }},
      {"zero_area_triangle",
       [](Scene& s) {
         mesh(s).mesh.triangles[1] = {0, 2, 2};
       }},
      {"non_manifold_mesh",
       [](Scene& s) {
         mesh(s).mesh.vertices.emplace_back(0, 0, 1);
         mesh(s).mesh.triangles.push_back({0, 2, 4});
         mesh(s).mesh.corner_uv.push_back({Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)});
       }},
  };
  for (const Case& c : cases) {
    Scene scene = mesh_scene();
    c.spoil(scene);
    EXPECT_THAT(found(scene), Contains(c.expected + " /garments/0/mesh"));
  }
}

TEST(CheckScene, NamesWhatIsWrongWithFabricsBodiesPinsAndSolver) {
  const auto pin = [](Scene& s) -> Pin& { return s.garments[0].pins.emplace_back(); };
  const std::vector<Case> cases = {
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.area_density = 0; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.stretch_stiffness.bias = kNan; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.poisson_stiffness = 1800; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.bending_stiffness.warp = -1; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.bending_softening.bias = -1e-3; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.bending_hysteresis.weft = kNan; }},
      {"fabric_value /garments/0/fabric", [](Scene& s) { s.garments[0].fabric.bending_hysteresis_onset = 0; }},
      {"fold_value /garments/0/seams/bending_factor",
       [](Scene& s) { s.garments[0].seam_bending.stiffness_factor = 0; }},
      {"unknown_edge /garments/0/folds/0/edge",
       [](Scene& s) {
         s.garments[0].folds = {{PinEdge{0, 99}, 1, 1}};
       }},
      {"unknown_label /garments/0/folds/0/label",
       [](Scene& s) {
         s.garments[0].folds = {{PinLabel{"cuff"}, 1, 1}};
       }},
      {"vertex_out_of_range /garments/0/folds/0/vertices",
       [](Scene& s) {
         s.garments[0].folds = {{PinVertices{{0, 1}}, 1, 1}};
       }},
      {"fold_value /garments/0/folds/0",
       [](Scene& s) {
         s.garments[0].folds = {{PinEdge{0, 0}, 4, 1}};
       }},
      {"body_value /body/sphere",
       [](Scene& s) {
         s.body->shape = SphereBody{Vec3::Zero(), 0};
       }},
      {"body_value /body/plane",
       [](Scene& s) {
         s.body->shape = PlaneBody{Vec3::Zero(), Vec3::Zero()};
       }},
      {"body_value /body/friction", [](Scene& s) { s.body->friction = -1; }},
      {"empty_body /body/mesh", [](Scene& s) { s.body->shape = MeshBody{}; }},
      {"unknown_label /garments/0/pins/0/label", [&](Scene& s) { pin(s).select = PinLabel{"cuff"}; }},
      {"unknown_edge /garments/0/pins/0/edge",
       [&](Scene& s) {
         pin(s).select = PinEdge{1, 4};
       }},
      {"empty_box /garments/0/pins/0/box_mm",
       [&](Scene& s) {
         pin(s).select = PinBox{Vec3::Ones(), Vec3::Zero()};
       }},
      {"attached_without_body /garments/0/pins/0",
       [&](Scene& s) {
         pin(s) = {PinLabel{"lower_interface"}, PinAttached{}};
         s.body.reset();
       }},
      {"times_not_rising /garments/0/pins/0",
       [&](Scene& s) {
         PinMoved moved;
         moved.key_frames.resize(2);
         pin(s).hold = moved;
       }},
      {"unknown_label /garments/0/elastics/0/label",
       [](Scene& s) {
         s.garments[0].elastics = {{PinLabel{"cuff"}, 0.8, 30, 0}};
       }},
      {"trim_value /garments/0/elastics/0/length_percent",
       [](Scene& s) {
         s.garments[0].elastics = {{PinLabel{"lower_interface"}, kNan, 30, 0}};
       }},
      {"trim_value /garments/0/drawcords/0/stiffness_N",
       [](Scene& s) {
         s.garments[0].drawcords = {{PinLabel{"lower_interface"}, 0.7, 0, 0}};
       }},
      {"selects_no_edge /garments/0/drawcords/0",
       [](Scene& s) {
         s.garments[0].drawcords = {{PinNearest{Vec3::Zero()}, 0.7, 100, 0}};
       }},
      {"unknown_panel /garments/0/trims/0/attach/0/panel",
       [](Scene& s) {
         s.garments[0].trims = {{{}, {{"sleeve", Vec2::Zero()}}}};
       }},
      {"trim_value /garments/0/trims/0/attach", [](Scene& s) { s.garments[0].trims.resize(1); }},
      {"trim_value /garments/0/trims/0/button",
       [](Scene& s) {
         s.garments[0].trims = {{{0.01, 0.002, 0}, {{"front", Vec2::Zero()}}}};
       }},
      {"pin_value /garments/0/pins/0/friction",
       [&](Scene& s) {
         pin(s) = {PinLabel{"lower_interface"}, PinAttached{true, -1}};
       }},
      {"solver_value /solver/max_time_step_s", [](Scene& s) { s.solver.max_time_step = kNan; }},
      {"solver_value /solver/line_search_iterations", [](Scene& s) { s.solver.line_search_iterations = 0; }},
      {"solver_value /solver/splitting_factor", [](Scene& s) { s.solver.splitting_factor = 1; }},
      {"fabric_value /garments/0/fabric",
       [](Scene& s) {
         s.garments[0].fabric.bending_stiffness = {1e-4, 4e-6, 5e-6};
       }},
      {"solver_value /solver/weight_ramp_s",
       [](Scene& s) { s.solver.weight_ramp_time = s.solver.simulated_time_limit; }},
  };
  for (const Case& c : cases) {
    Scene scene = good_scene();
    c.spoil(scene);
    EXPECT_THAT(found(scene), Contains(c.expected));
  }
}

TEST(CheckScene, ReportsAllFindingsAtOnce) {
  Scene scene = good_scene();
  pattern(scene).panels[0].vertices[0].x() = kNan;
  pattern(scene).stitches[0].a.edge = 9;
  scene.garments[0].fabric.area_density = -1;
  try {
    check_scene(scene);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
}

}  // namespace
}  // namespace toile
