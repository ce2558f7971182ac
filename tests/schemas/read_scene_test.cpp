#include "schemas/read_scene.h"

#include "engine/scene/problem.h"
#include "schemas/fabrics.h"
#include "schemas/solver_keys.h"
#include "tests/schemas/files.h"
#include "tests/schemas/pattern_geometry.h"

#include <gmock/gmock.h>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using testing::problems_of;

std::string no_reference(const json& reference, const std::string& pointer) {
  throw InputError(pointer, "unexpected_reference", reference.dump());
}

Job read(const std::string& text, const Resolver& resolve = no_reference) {
  return read_scene(parse_json(text), resolve);
}

Garment garment_from(const std::string& text) { return read(R"({"garments": [)" + text + "]}").scene.garments[0]; }

Body body_from(const std::string& text) {
  return *read(R"({"garments": [{"disc": {"radius_mm": 150}}], "body": )" + text + "}").scene.body;
}

std::vector<std::string> pinned_labels(const Garment& garment) {
  std::vector<std::string> labels;
  for (const Pin& pin : garment.pins) {
    EXPECT_TRUE(std::holds_alternative<PinAttached>(pin.hold));
    labels.push_back(std::get<PinLabel>(pin.select).label);
  }
  return labels;
}

TEST(ReadScene, TheSmallestHasAllDefaults) {
  const Job job = read(R"({"garments": [{"disc": {"radius_mm": 150}}]})");
  const Garment& garment = job.scene.garments.at(0);
  EXPECT_EQ(garment.name, "garment_0");
  EXPECT_EQ(garment.fabric.name, "poplin");
  EXPECT_DOUBLE_EQ(garment.edge_length, Garment{}.edge_length);
  EXPECT_TRUE(garment.pins.empty());
  EXPECT_FALSE(job.scene.body.has_value());
  EXPECT_EQ(job.scene.fidelity, Scene{}.fidelity);
  EXPECT_THAT(job.render.views, ElementsAre("front", "back"));
  EXPECT_THAT(job.render.overlays, ElementsAre("fabric"));
  EXPECT_EQ(job.render.width, 1024);
  EXPECT_TRUE(job.warnings.empty());
}

TEST(ReadScene, LengthsBecomeMetres) {
  const Garment garment = garment_from(
      R"({"rectangle": {"width_mm": 400, "height_mm": 300}, "edge_length_mm": 7, "name": "towel",
          "transform": {"translate_mm": [100, 200, 300]}})");
  const Panel& panel = std::get<Pattern>(garment.shape).panels[0];
  EXPECT_NEAR(testing::signed_area(panel), 0.12, 1e-12);
  EXPECT_TRUE(panel.translation.isApprox(Vec3(0.1, 0.2, 0.3)));
  EXPECT_DOUBLE_EQ(garment.edge_length, 0.007);
  EXPECT_EQ(garment.name, "towel");
}

TEST(ReadScene, TheTransformComesAfterThePlacement) {
  const Garment garment = garment_from(
      R"({"rectangle": {"width_mm": 400, "height_mm": 300}, "transform": {"rotate_deg": [90, 0, 90], "translate_mm": [0, 0, 50]}})");
  const Panel& panel = std::get<Pattern>(garment.shape).panels[0];
  // Flat with its normal up, about x it faces +z, about z it stays so.
  EXPECT_EQ(testing::outward_normal(panel), Vec3(0, 0, 1));
  EXPECT_EQ(panel.rotation * Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_DOUBLE_EQ(panel.translation.z(), 0.05);
}

TEST(ReadScene, FabricsByNameInlineAndByPanel) {
  const Garment garment = garment_from(
      R"({"disc": {"radius_mm": 150}, "fabric": "denim",
          "panel_fabrics": {"disc": {"base": "jersey", "area_density_g_m2": 180, "stretch_N_m": {"warp": 400, "weft": 100, "bias": 30}}}})");
  EXPECT_EQ(garment.fabric.name, "denim");
  const Fabric& fabric = garment.panel_fabrics.at("disc");
  EXPECT_DOUBLE_EQ(fabric.area_density, 0.18);
  EXPECT_DOUBLE_EQ(fabric.stretch_stiffness.bias, 30);
  EXPECT_DOUBLE_EQ(fabric.poisson_stiffness, 0.4 * 200);
  EXPECT_DOUBLE_EQ(fabric.bending_stiffness.warp, read_fabric("jersey").bending_stiffness.warp);
  EXPECT_FALSE(fabric.woven);
  EXPECT_EQ(std::get<Pattern>(garment.shape).panels[0].fabric->name, fabric.name);
}

TEST(ReadScene, ReadingsOfAStretchTestBecomeStressCurves) {
  const Fabric fabric = garment_from(R"({"disc": {"radius_mm": 150}, "fabric": {
      "base": "poplin", "poisson_ratio": 0, "stretch_curve": {
        "warp": [{"strain_percent": 10, "force_N_m": 22}, {"strain_percent": 20, "force_N_m": 60}]}}})")
                            .fabric;
  ASSERT_EQ(fabric.warp_stress.knots.size(), 3u);
  EXPECT_NEAR(fabric.warp_stress.at(0.105).stress, 20, 1e-12) << "Green strain and second Piola-Kirchhoff stress";
  EXPECT_DOUBLE_EQ(fabric.stretch_stiffness.warp, fabric.warp_stress.initial_tangent());
  EXPECT_TRUE(fabric.weft_stress.empty());
  EXPECT_DOUBLE_EQ(fabric.stretch_stiffness.weft, read_fabric("poplin").stretch_stiffness.weft);
  EXPECT_TRUE(read_fabric("poplin").warp_stress.empty());
}

/// An OBJ of one square whose sides are `size` and whose texture is `uv_size` wide.
std::string square_obj(double size, double uv_size) {
  std::string text;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
    text += "v " + std::to_string(x * size) + " " + std::to_string(y * size) + " 0\\nvt " +
            std::to_string(x * uv_size) + " " + std::to_string(y * uv_size) + "\\n";
  return text + "f 1/1 2/2 3/3\\nf 1/1 3/3 4/4\\n";
}

TEST(ReadScene, TheSameGarmentInOtherUnitsIsTheSameScene) {
  const auto mesh = [](const std::string& obj, const std::string& units) {
    return std::get<GarmentMesh>(garment_from(R"({"mesh": {"inline": ")" + obj + "\"" + units + "}}").shape);
  };
  const GarmentMesh metres = mesh(square_obj(0.5, 0.5), "");
  const GarmentMesh others = mesh(square_obj(500, 50), R"(, "unit_mm": 1, "uv_unit_mm": 10)");
  ASSERT_EQ(metres.mesh.vertices.size(), others.mesh.vertices.size());
  for (std::size_t v = 0; v < metres.mesh.vertices.size(); ++v)
    EXPECT_LT((metres.mesh.vertices[v] - others.mesh.vertices[v]).norm(), 1e-15);
  for (std::size_t t = 0; t < metres.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((metres.mesh.corner_uv[t][k] * metres.uv_unit - others.mesh.corner_uv[t][k] * others.uv_unit).norm(),
                1e-15);

  const auto panel = [](double size, const std::string& units) {
    char s_text[32];
    std::snprintf(s_text, sizeof s_text, "%.17g", size);
    const std::string s = s_text;
    return std::get<Pattern>(
               garment_from(R"({"pattern": {"inline": {"pattern": {"panels": {"p": {"vertices": [[0, 0], [)" + s +
                            ", 0], [" + s + ", " + s + "], [0, " + s + R"(]], "edges": [{"endpoints": [0, 1]},
                            {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
                            "rotation": [0, 0, 0], "translation": [)" +
                            s + ", 0, 0]}}, \"stitches\": []}, " + R"("properties": {"units_in_meter": )" + units +
                            R"(, "curvature_coords": "relative"}}}})")
                   .shape)
        .panels.at(0);
  };
  const Panel centimetres = panel(50, "100"), inches = panel(50 / 2.54, "39.37007874015748");
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LT((centimetres.vertices[v] - inches.vertices[v]).norm(), 1e-15);
  EXPECT_LT((centimetres.translation - inches.translation).norm(), 1e-15);
}

TEST(ReadScene, GrainInDegreesForGarmentAndPanels) {
  const Garment garment =
      garment_from(R"({"disc": {"radius_mm": 150}, "grain_deg": 45, "panel_grain_deg": {"disc": -90}})");
  EXPECT_DOUBLE_EQ(garment.grain, M_PI / 4);
  EXPECT_DOUBLE_EQ(garment.panel_grain.at("disc"), -M_PI / 2);
  EXPECT_EQ(garment_from(R"({"disc": {"radius_mm": 150}})").grain, 0);
}

TEST(ReadScene, Pins) {
  const Garment garment = garment_from(R"({"rectangle": {"width_mm": 400, "height_mm": 300}, "pins": [
      {"vertices": [0, 5]},
      {"edge": {"panel": "rectangle", "edge": 2}, "hold": "fixed"},
      {"box_mm": {"min": [-1, -2, -3], "max": [1, 2, 3]}},
      {"nearest_mm": [200, 0, 150], "hold": {"pivot_mm": [0, 0, 10], "key_frames": [
          {"time_s": 0}, {"time_s": 1.5, "translate_mm": [0, 20, 0], "rotate_deg": [0, 720, 0]}]}}]})");
  ASSERT_EQ(garment.pins.size(), 4u);
  EXPECT_THAT(std::get<PinVertices>(garment.pins[0].select).vertices, ElementsAre(0, 5));
  EXPECT_TRUE(std::holds_alternative<PinFixed>(garment.pins[0].hold));
  EXPECT_EQ(std::get<PinEdge>(garment.pins[1].select).panel, 0);
  EXPECT_EQ(std::get<PinEdge>(garment.pins[1].select).edge, 2);
  EXPECT_TRUE(std::get<PinBox>(garment.pins[2].select).max.isApprox(Vec3(0.001, 0.002, 0.003)));
  EXPECT_TRUE(std::get<PinNearest>(garment.pins[3].select).point.isApprox(Vec3(0.2, 0, 0.15)));
  const auto& moved = std::get<PinMoved>(garment.pins[3].hold);
  EXPECT_DOUBLE_EQ(moved.pivot.z(), 0.01);
  EXPECT_DOUBLE_EQ(moved.key_frames[1].time, 1.5);
  EXPECT_DOUBLE_EQ(moved.key_frames[1].translation.y(), 0.02);
  EXPECT_DOUBLE_EQ(moved.key_frames[1].rotation_vector.y(), 4 * M_PI) << "about one axis, whole turns are kept";
}

TEST(ReadScene, ElasticsAndDrawcords) {
  const Garment garment = garment_from(
      R"({"rectangle": {"width_mm": 400, "height_mm": 300},
          "elastics": [{"edge": {"panel": "rectangle", "edge": 2}, "length_percent": 80, "stiffness_N": 12}],
          "drawcords": [{"vertices": [0, 1, 2], "length_mm": 350, "damping_s": 0.5}]})");
  ASSERT_EQ(garment.elastics.size(), 1u);
  EXPECT_EQ(std::get<PinEdge>(garment.elastics[0].select).edge, 2);
  EXPECT_DOUBLE_EQ(garment.elastics[0].length_factor, 0.8);
  EXPECT_DOUBLE_EQ(garment.elastics[0].stiffness, 12);
  EXPECT_DOUBLE_EQ(garment.elastics[0].damping, Elastic{}.damping);
  ASSERT_EQ(garment.drawcords.size(), 1u);
  EXPECT_THAT(std::get<PinVertices>(garment.drawcords[0].select).vertices, ElementsAre(0, 1, 2));
  EXPECT_DOUBLE_EQ(garment.drawcords[0].length, 0.35);
  EXPECT_DOUBLE_EQ(garment.drawcords[0].stiffness, Drawcord{}.stiffness);
  EXPECT_DOUBLE_EQ(garment.drawcords[0].damping, 0.5);
}

TEST(ReadScene, Buttons) {
  const Garment garment = garment_from(
      R"({"rectangle": {"width_mm": 400, "height_mm": 300},
          "trims": [{"button": {"diameter_mm": 20, "mass_g": 2}, "attach": [{"panel": "rectangle", "at_mm": [10, -20]}],
                     "stiffness_N_m": 300}]})");
  ASSERT_EQ(garment.trims.size(), 1u);
  const Trim& trim = garment.trims[0];
  EXPECT_DOUBLE_EQ(trim.button.diameter, 0.02);
  EXPECT_DOUBLE_EQ(trim.button.thickness, Button{}.thickness);
  EXPECT_DOUBLE_EQ(trim.button.mass, 2e-3);
  ASSERT_EQ(trim.holes.size(), 1u);
  EXPECT_EQ(trim.holes[0].panel, "rectangle");
  EXPECT_LT((trim.holes[0].at - Vec2(0.01, -0.02)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(trim.stiffness, 300);
  EXPECT_DOUBLE_EQ(trim.damping, Trim{}.damping);
}

TEST(ReadScene, Zippers) {
  const Garment garment = garment_from(
      R"({"rectangle": {"width_mm": 400, "height_mm": 300},
          "zippers": [{"sides": [{"edge": {"panel": "rectangle", "edge": 1}}, {"edge": {"panel": "rectangle", "edge": 3}}]},
                      {"sides": [{"edge": {"panel": "rectangle", "edge": 0}}, {"edge": {"panel": "rectangle", "edge": 2}}],
                       "bottom": "end", "closed_percent": 40, "mass_g_m": 12, "stiffness_N": 900, "bending_N_mm2": 15,
                       "damping_s": 0.1, "slider": {"size_mm": [6, 9, 4], "mass_g": 1.5}, "stops": {"mass_g": 0.1},
                       "thread_stiffness_N_m": 500, "thread_damping_s": 0.01, "friction": 0.4}]})");
  ASSERT_EQ(garment.zippers.size(), 2u);
  const Zipper &untold = garment.zippers[0], &told = garment.zippers[1], usual;
  EXPECT_EQ(std::get<PinEdge>(untold.sides[1]).edge, 3);
  EXPECT_FALSE(untold.from_end);
  for (double Zipper::*member :
       {&Zipper::closed_fraction, &Zipper::mass_per_length, &Zipper::stiffness, &Zipper::bending, &Zipper::damping,
        &Zipper::thread_stiffness, &Zipper::thread_damping, &Zipper::friction})
    EXPECT_DOUBLE_EQ(untold.*member, usual.*member);
  for (ZipperEnd Zipper::*end : {&Zipper::slider, &Zipper::stop}) {
    EXPECT_DOUBLE_EQ((untold.*end).mass, (usual.*end).mass);
    EXPECT_LT(((untold.*end).size - (usual.*end).size).norm(), 1e-15);
  }
  EXPECT_TRUE(told.from_end);
  EXPECT_DOUBLE_EQ(told.closed_fraction, 0.4);
  EXPECT_DOUBLE_EQ(told.mass_per_length, 0.012);
  EXPECT_DOUBLE_EQ(told.stiffness, 900);
  EXPECT_DOUBLE_EQ(told.bending, 15e-6);
  EXPECT_DOUBLE_EQ(told.damping, 0.1);
  EXPECT_LT((told.slider.size - Vec3(6e-3, 9e-3, 4e-3)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(told.slider.mass, 1.5e-3);
  EXPECT_LT((told.stop.size - usual.stop.size).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(told.stop.mass, 1e-4);
  EXPECT_DOUBLE_EQ(told.thread_stiffness, 500);
  EXPECT_DOUBLE_EQ(told.thread_damping, 0.01);
  EXPECT_DOUBLE_EQ(told.friction, 0.4);
}

TEST(ReadScene, ASlidingPinHasItsFrictionOrTheBodys) {
  const auto hold = [](const std::string& friction) {
    const Job job = read(R"({"garments": [{"disc": {"radius_mm": 150}, "pins": [{"vertices": [0], "hold": "sliding")" +
                         friction + R"(}]}], "body": {"sphere": {"radius_mm": 100}}})");
    return std::get<PinAttached>(job.scene.garments[0].pins[0].hold);
  };
  EXPECT_TRUE(hold("").slides);
  EXPECT_FALSE(hold("").friction.has_value());
  EXPECT_DOUBLE_EQ(hold(R"(, "friction": 0.7)").friction.value(), 0.7);
}

TEST(ReadScene, Bodies) {
  EXPECT_DOUBLE_EQ(std::get<SphereBody>(body_from(R"({"sphere": {"radius_mm": 100}})").shape).radius, 0.1);
  const auto capsule = std::get<CapsuleBody>(
      body_from(R"({"capsule": {"radius_mm": 30, "start_mm": [0, 0, 0], "end_mm": [0, 500, 0]}})").shape);
  EXPECT_DOUBLE_EQ(capsule.end.y(), 0.5);
  const auto cylinder = std::get<CylinderBody>(
      body_from(R"({"cylinder": {"radius_mm": 90, "start_mm": [0, -10, 0], "end_mm": [0, 0, 0]}})").shape);
  EXPECT_DOUBLE_EQ(cylinder.start.y(), -0.01);
  const auto box = std::get<BoxBody>(
      body_from(R"({"box": {"size_mm": [200, 400, 600], "center_mm": [0, 1000, 0], "rotate_deg": [0, 90, 0]}})").shape);
  EXPECT_TRUE(box.half_extents.isApprox(Vec3(0.1, 0.2, 0.3)));
  EXPECT_EQ(box.rotation * Vec3(1, 0, 0), Vec3(0, 0, -1));
  const auto plane = std::get<PlaneBody>(body_from(R"({"plane": {"normal": [0, 0, 7]}})").shape);
  EXPECT_EQ(plane.normal, Vec3(0, 0, 1));
  const auto floor = std::get<PlaneBody>(body_from(R"({"plane": {}})").shape);
  EXPECT_EQ(floor.normal, Vec3::UnitY());
  const auto form = std::get<DressFormBody>(body_from(R"({"dress_form": {"waist_mm": 700}})").shape);
  EXPECT_DOUBLE_EQ(form.waist, 0.7);
  EXPECT_DOUBLE_EQ(form.bust, DressFormBody{}.bust);
}

TEST(ReadScene, FrictionOfTheBodyOrOfEachFabricAndOfPairs) {
  EXPECT_EQ(body_from(R"({"plane": {}, "friction": 0.45})").friction, 0.45);
  EXPECT_EQ(body_from(R"({"plane": {}})").friction, std::nullopt);
  const Scene scene = read(R"({"garments": [{"disc": {"radius_mm": 150}}], "body": {"plane": {}},
      "friction_pairs": [{"between": ["poplin", "body"], "coefficient": 0.1},
                         {"between": ["poplin", "poplin"], "coefficient": 0.7}]})")
                          .scene;
  ASSERT_EQ(scene.friction_pairs.size(), 2u);
  EXPECT_EQ(scene.friction_pairs[0].other, "");
  EXPECT_EQ(scene.friction_pairs[0].coefficient, 0.1);
  EXPECT_EQ(scene.friction_pairs[1].other, "poplin");
}

TEST(ReadScene, MeshesHaveTheirUnitAndAxis) {
  const std::string obj = "v 1 2 3\nv 4 2 3\nv 1 5 3\nvt 0 0\nvt 3 0\nvt 0 3\nf 1/1 2/2 3/3\n";
  const json document = json::parse(R"({"garments": [{"mesh": {"asset": "", "unit_mm": 10, "up": "z",
      "uv_unit_mm": 25, "seams": [[0, 1]]}, "transform": {"translate_mm": [0, 0, 1000]}}]})");
  json scene = document;
  const std::string asset = "sha256:" + std::string(64, 'a');
  scene["garments"][0]["mesh"]["asset"] = asset;
  const Job job = read_scene(scene, [&](const json& reference, const std::string& pointer) {
    EXPECT_EQ(reference["asset"], asset);
    EXPECT_EQ(pointer, "/garments/0/mesh");
    return obj;
  });
  const auto& garment = std::get<GarmentMesh>(job.scene.garments[0].shape);
  EXPECT_DOUBLE_EQ(garment.uv_unit, 0.025);
  EXPECT_EQ(garment.seams.size(), 1u);
  EXPECT_TRUE(garment.mesh.vertices[0].isApprox(Vec3(0.01, 0.03, 0.98)));
  EXPECT_THAT(asset_references(scene), ElementsAre(asset));
}

class PatternForms : public ::testing::TestWithParam<const char*> {};

TEST_P(PatternForms, AreAllRead) {
  const std::string pattern = R"({"pattern": {"panels": {"p": {"vertices": [[0,0],[9,0],[0,9]],
      "edges": [{"endpoints":[0,1]},{"endpoints":[1,2]},{"endpoints":[2,0]}]}}}, "properties": {}, "extra": 1})";
  const std::string form = GetParam();
  const std::string source = form == "document" ? pattern
                             : form == "inline" ? R"({"inline": )" + pattern + "}"
                                                : R"({")" + form + R"(": "sha256:)" + std::string(64, '0') + "\"}";
  const Job job =
      read(R"({"garments": [{"pattern": )" + source + "}]}", [&](const json&, const std::string&) { return pattern; });
  EXPECT_EQ(std::get<Pattern>(job.scene.garments[0].shape).panels[0].name, "p");
}

INSTANTIATE_TEST_SUITE_P(All, PatternForms, ::testing::Values("document", "inline", "file", "asset"),
                         [](const auto& form) { return std::string(form.param); });

TEST(ReadScene, FilesAreForTheCommandLineOnly) {
  const json scene =
      parse_json(R"({"garments": [{"pattern": {"file": "/etc/passwd"}}], "body": {"mesh": {"file": "b.obj"}}})");
  EXPECT_NO_THROW(validate_scene_document(scene));
  const auto problems = problems_of([&] { validate_scene_document(scene, FileReferences::refused); });
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].pointer, "/garments/0/pattern/file");
  EXPECT_EQ(problems[0].code, "file_not_allowed");
  EXPECT_EQ(problems[1].pointer, "/body/mesh/file");
}

TEST(FileResolver, FindsFilesAndLaidAssets) {
  const auto base = std::filesystem::temp_directory_path() / "toile_file_resolver_test";
  std::filesystem::create_directories(base / "assets");
  const std::string hash(64, 'b');
  std::ofstream(base / "a.json") << "A";
  std::ofstream(base / "assets" / hash) << "B";
  const Resolver resolve = file_resolver(base);
  EXPECT_EQ(resolve({{"file", "a.json"}}, ""), "A");
  EXPECT_EQ(resolve({{"file", (base / "a.json").string()}}, ""), "A");
  EXPECT_EQ(resolve({{"asset", "sha256:" + hash}}, ""), "B");
  const auto missing = problems_of([&] { resolve({{"file", "none.json"}}, "/garments/0/pattern"); });
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].pointer, "/garments/0/pattern/file");
  EXPECT_EQ(missing[0].code, "file_not_found");
  EXPECT_EQ(problems_of([&] { resolve({{"file", "assets"}}, ""); })[0].code, "file_not_found");
  EXPECT_EQ(problems_of([&] {
              resolve({{"asset", "sha256:" + std::string(64, 'c')}}, "");
            })[0]
                .code,
            "asset_not_found");
  std::filesystem::remove_all(base);
}

struct Attachment {
  const char* spec;
  std::vector<std::string> labels;
};

class Attachments : public ::testing::TestWithParam<Attachment> {};

TEST_P(Attachments, FollowTheLabels) {
  const std::string specs = TOILE_SHARED "/data/specs";
  if (!std::filesystem::exists(specs)) GTEST_SKIP() << "needs ../shared";
  const json scene = {{"garments", {{{"pattern", {{"file", std::string(GetParam().spec) + "_specification.json"}}}}}},
                      {"body", {{"dress_form", json::object()}}}};
  const Job job = read_scene(scene, file_resolver(specs));
  EXPECT_EQ(pinned_labels(job.scene.garments[0]), GetParam().labels);
}

INSTANTIATE_TEST_SUITE_P(Specs, Attachments,
                         ::testing::Values(Attachment{"circle_skirt", {"lower_interface"}},
                                           Attachment{"godet_skirt", {"lower_interface"}},
                                           Attachment{"pants", {"lower_interface"}},
                                           Attachment{"strapless_top", {"strapless_top"}}, Attachment{"tshirt", {}},
                                           Attachment{"fitted_shirt_collar", {}}, Attachment{"hoody", {}},
                                           Attachment{"pencil_dress", {}}, Attachment{"repo_hoody_mean", {}},
                                           Attachment{"repo_shirt_mean", {}}),
                         [](const auto& spec) { return std::string(spec.param.spec); });

TEST(Folds, AreReadWithSeamsAndClamps) {
  const json document = testing::json_from(TOILE_SOURCE "/schemas/examples/valid/folded_and_clamped.json");
  const Garment garment = read_scene(document, no_reference).scene.garments[0];
  EXPECT_EQ(garment.seam_bending.stiffness_factor, 4);
  ASSERT_EQ(garment.folds.size(), 1u);
  EXPECT_EQ(std::get<PinEdge>(garment.folds[0].select).panel, 1);
  EXPECT_EQ(std::get<PinEdge>(garment.folds[0].select).edge, 2);
  EXPECT_NEAR(garment.folds[0].angle, -2 * M_PI / 3, 1e-12);
  EXPECT_EQ(garment.folds[0].stiffness_factor, 2);
  ASSERT_EQ(garment.pins.size(), 1u);
  EXPECT_TRUE(garment.pins[0].clamp);
  const Directional &softening = garment.fabric.bending_softening, &loop = garment.fabric.bending_hysteresis;
  EXPECT_DOUBLE_EQ(softening.warp, 2.7e-3);
  EXPECT_DOUBLE_EQ(softening.weft, 2.4e-3);
  EXPECT_DOUBLE_EQ(softening.bias, 2.4e-3);
  EXPECT_DOUBLE_EQ(loop.warp, 400e-6);
  EXPECT_DOUBLE_EQ(loop.weft, 300e-6);
  EXPECT_DOUBLE_EQ(loop.bias, 350e-6);
  EXPECT_EQ(garment.fabric.bending_hysteresis_onset, 15);
  const Garment plain = garment_from(R"({"disc": {"radius_mm": 150}, "pins": [{"vertices": [0]}]})");
  EXPECT_FALSE(plain.pins[0].clamp);
  EXPECT_TRUE(plain.folds.empty());
  EXPECT_EQ(plain.seam_bending.stiffness_factor, 1);
  EXPECT_EQ(plain.fabric.bending_softening, Directional{});
}

TEST(Attach, CanBeTurnedOffNamedAndOverridden) {
  const std::string pattern = R"("pattern": {"pattern": {"panels": {"p": {"vertices": [[0,0],[9,0],[0,9]],
      "edges": [{"endpoints":[0,1],"label":"lower_interface"},{"endpoints":[1,2],"label":"cuff"},{"endpoints":[2,0]}]}}}})";
  const auto labels = [&](const std::string& more, const std::string& body = R"("body": {"plane": {}})") {
    return pinned_labels(read(R"({"garments": [{)" + pattern + more + "}]," + body + "}").scene.garments[0]);
  };
  EXPECT_THAT(labels(""), ElementsAre("lower_interface"));
  EXPECT_THAT(labels(R"(, "attach": "none")"), ElementsAre());
  EXPECT_THAT(labels(R"(, "attach": ["cuff"])"), ElementsAre("cuff"));
  EXPECT_THAT(labels("", R"("fidelity": "standard")"), ElementsAre()) << "no body";
  const Garment garment =
      read(R"({"garments": [{)" + pattern + R"(, "pins": [{"label": "lower_interface"}]}], "body": {"plane": {}}})")
          .scene.garments[0];
  ASSERT_EQ(garment.pins.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<PinFixed>(garment.pins[0].hold));
}

TEST(SolverOptions, DefaultsInTheSchemaAreThoseOfTheEngine) {
  const json schema = testing::json_from(TOILE_SOURCE "/schemas/scene.schema.json");
  const json keys = schema["definitions"]["solver"]["properties"];
  SolverOptions defaults;
  std::size_t count = 0;
  for_each_solver_key(defaults, [&](const char* key, auto& member, double unit) {
    ++count;
    ASSERT_TRUE(keys.contains(key)) << key;
    const json& value = keys[key]["default"];
    const double number = value.is_boolean() ? value.get<bool>() : value.get<double>();
    EXPECT_DOUBLE_EQ(number * unit, static_cast<double>(member)) << key;
  });
  EXPECT_EQ(keys.size(), count) << "each key of the schema sets an option";
}

TEST(SolverOptions, EachOptionHasAKey) {
  // Does not compile when an option was added: give it a key in solver_keys.h and in scene.schema.json, and count on.
  const SolverOptions options;
  [[maybe_unused]] const auto& [o1, o2, o3, o4, o5, o6, o7, o8, o9, o10, o11, o12, o13, o14, o15, o16, o17, o18, o19,
                                o20, o21, o22, o23, o24] = options;
  int count = 0;
  for_each_solver_key(options, [&](const char*, const auto&, double) { ++count; });
  EXPECT_EQ(count, 24);
}

TEST(SolverOptions, EachKeySetsItsOptionAlone) {
  SolverOptions defaults;
  for_each_solver_key(defaults, [&](const char* key, auto& unchanged, double unit) {
    using Member = std::decay_t<decltype(unchanged)>;
    json value;
    if constexpr (std::is_same_v<Member, bool>) {
      value = !unchanged;
    } else if constexpr (std::is_same_v<Member, int>) {
      value = unchanged + 1;
    } else {
      value = unchanged == 0 ? 0.5 : unchanged / unit / 2;
    }
    const json scene = {{"garments", {{{"disc", {{"radius_mm", 1}}}}}}, {"solver", {{key, value}}}};
    SolverOptions options = read_scene(scene, no_reference).scene.solver;
    for_each_solver_key(options, [&](const std::string& other, auto& member, double) {
      SolverOptions fresh;
      for_each_solver_key(fresh, [&](const std::string& same, auto& original, double) {
        if (same != other) return;
        EXPECT_EQ(static_cast<double>(member) == static_cast<double>(original), other != key) << key;
      });
    });
  });
}

}  // namespace
}  // namespace toile
