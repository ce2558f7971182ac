#include "schemas/read_measurements.h"

#include "engine/scene/problem.h"
#include "schemas/fabrics.h"
#include "schemas/parse_json.h"
#include "schemas/problem.h"
#include "schemas/validate.h"
#include "schemas/write_fabric_fit.h"
#include "tests/schemas/files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

namespace toile {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kMeasurements = TOILE_SOURCE "/schemas/examples/measurements";
constexpr std::size_t kWarp = 0, kWeft = 1, kBias = 2;

FabricMeasurements measurements_of(const char* text) { return read_measurements(parse_json(text)); }

std::vector<std::string> documents(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    if (entry.is_regular_file() && name.find(".problem") == std::string::npos) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(ReadMeasurements, UnitsBecomeSi) {
  const FabricMeasurements m = measurements_of(R"({"area_density_g_m2": 150, "thickness_mm": 0.3, "poisson_ratio": 0.1,
    "uniaxial": {"warp": {"length_mm": 100, "width_mm": 25, "uncertainty_percent": 4,
                          "readings": [{"strain_percent": 1, "force_N": 0.5}, {"strain_percent": 2, "force_N_m": 45}]}},
    "bias_extension": {"readings": [{"strain_percent": 3, "force_N_m": 7}]},
    "cantilever": {"warp": {"overhang_mm": 40}, "weft": {"bending_length_mm": 15, "width_mm": 20},
                   "bias": {"overhang_mm": 60, "drop_mm": 30}},
    "pear_loop": {"weft": {"length_mm": 120, "height_mm": 54}},
    "bending_uN_m": {"bias": 4}, "shear_N_m": 56})");
  EXPECT_EQ(m.base.name, "poplin");
  EXPECT_DOUBLE_EQ(m.area_density, 0.15);
  EXPECT_DOUBLE_EQ(*m.thickness, 3e-4);
  EXPECT_DOUBLE_EQ(*m.poisson_ratio, 0.1);
  const MeasuredPull& warp = *m.pulls[kWarp];
  EXPECT_DOUBLE_EQ(warp.length, 0.1);
  EXPECT_DOUBLE_EQ(warp.uncertainty, 0.04);
  EXPECT_TRUE(warp.as_curve);
  EXPECT_DOUBLE_EQ(warp.readings[0].strain, 0.01);
  EXPECT_DOUBLE_EQ(warp.readings[0].force, 20) << "0.5 N on 25 mm";
  EXPECT_DOUBLE_EQ(warp.readings[1].force, 45);
  EXPECT_FALSE(m.pulls[kWeft]);
  EXPECT_FALSE(m.pulls[kBias]->as_curve) << "one reading makes no curve";
  EXPECT_DOUBLE_EQ(m.cantilevers[kWarp]->value, 41.5 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(m.cantilevers[kWeft]->overhang, 0.03) << "twice the bending length";
  EXPECT_DOUBLE_EQ(m.cantilevers[kWeft]->width, 0.02);
  EXPECT_EQ(m.cantilevers[kBias]->reading, MeasuredCantilever::Reading::drop);
  EXPECT_DOUBLE_EQ(m.cantilevers[kBias]->value, 0.03);
  EXPECT_DOUBLE_EQ(m.loops[kWeft]->height, 0.054);
  EXPECT_DOUBLE_EQ(m.bending[kBias]->value, 4e-6);
  EXPECT_DOUBLE_EQ(m.shear->value, 56);
}

TEST(ReadMeasurements, SchemasDefaultsAreTheStructs) {
  const json keys = bundled_schema("measurements.schema.json")["definitions"]["pull"]["properties"];
  EXPECT_DOUBLE_EQ(keys["length_mm"]["default"].get<double>(), 1e3 * MeasuredPull{}.length);
  EXPECT_DOUBLE_EQ(keys["width_mm"]["default"].get<double>(), 1e3 * MeasuredPull{}.width);
}

class ValidMeasurements : public ::testing::TestWithParam<std::string> {};

TEST_P(ValidMeasurements, AreRead) {
  EXPECT_NO_THROW(read_measurements(testing::json_from(kMeasurements / (GetParam() + ".json"))));
}

TEST_P(ValidMeasurements, HostileValuesAreReadOrRefused) {
  const json document = testing::json_from(kMeasurements / (GetParam() + ".json"));
  const json leaves = document.flatten();
  for (const auto& [pointer, leaf] : leaves.items())
    for (const json& value : {json(), json(-1), json(0), json(1e308), json(5e-324), json("x"), json::array()}) {
      json changed = document;
      changed[json::json_pointer(pointer)] = value;
      try {
        read_measurements(changed);
      } catch (const InputError& error) {
        EXPECT_FALSE(error.problems().empty());
      }
    }
}

class InvalidMeasurements : public ::testing::TestWithParam<std::string> {};

TEST_P(InvalidMeasurements, GetTheirProblem) {
  const json expected = testing::json_from(kMeasurements / "invalid" / (GetParam() + ".problem.json"));
  validate_document("problem.schema.json", expected);
  try {
    read_measurements(testing::json_from(kMeasurements / "invalid" / (GetParam() + ".json")));
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_EQ(problem_document(error), expected) << problem_document(error).dump(2);
  }
}

std::string document_name(const ::testing::TestParamInfo<std::string>& example) { return example.param; }
INSTANTIATE_TEST_SUITE_P(All, ValidMeasurements, ::testing::ValuesIn(documents(kMeasurements)), document_name);
INSTANTIATE_TEST_SUITE_P(All, InvalidMeasurements, ::testing::ValuesIn(documents(kMeasurements / "invalid")),
                         document_name);

/// A fit with a curve, a parameter that is not determined and one reading.
FabricFit some_fit(const FabricMeasurements& m) {
  FabricFit fit;
  fit.fabric = m.base;
  fit.fabric.area_density = m.area_density;
  fit.fabric.bending_stiffness = {3e-6, 2e-6, 2.5e-6};
  fit.stretch.weft = {{0.01, 12.5}, {0.03, 55}};
  apply_stretch_test(fit.stretch, 0.2, "", fit.fabric);
  fit.status = fit.stop_reason = "fitted";
  fit.misfit = {{"/uniaxial/weft/readings/0", MisfitRow::Quantity::force, 0.01, 12.5, 12.75, 0.02},
                {"/cantilever/warp", MisfitRow::Quantity::angle, {}, 0.72, 0.73, 0.02}};
  FitPart part;
  part.name = "bending";
  part.stop_reason = "no_better";
  part.parameters = {{"/bending_uN_m/warp", {}, 3e-6, std::numeric_limits<double>::infinity(), false}};
  part.singular_values = {2.0};
  fit.parts = {part};
  fit.kept = {"/friction_body"};
  return fit;
}

TEST(WriteFabricFit, TheFabricIsReadBackAsItWas) {
  const json asked = parse_json(R"({"name": "cloth", "base": "denim", "area_density_g_m2": 150, "shear_N_m": 56})");
  const FabricFit fit = some_fit(read_measurements(asked));
  const json document = write_fabric(fit, asked);
  const Fabric back = read_fabric(document);
  EXPECT_EQ(back.name, "cloth");
  EXPECT_DOUBLE_EQ(back.area_density, 0.15);
  EXPECT_EQ(document["base"], "denim");
  EXPECT_FALSE(document.contains("licence")) << "the base's source is not this cloth's";
  EXPECT_NEAR(back.bending_stiffness.warp, 3e-6, 1e-18);
  EXPECT_NEAR(back.stretch_stiffness.weft, fit.fabric.stretch_stiffness.weft, 1e-9);
  ASSERT_EQ(back.weft_stress.knots.size(), fit.fabric.weft_stress.knots.size());
  EXPECT_NEAR(back.weft_stress.at(0.02).stress, fit.fabric.weft_stress.at(0.02).stress, 1e-9);
  EXPECT_NEAR(back.poisson_stiffness, fit.fabric.poisson_stiffness, 1e-9);
  EXPECT_EQ(back.friction_cloth, fit.fabric.friction_cloth);
}

TEST(WriteFabricFit, TheReportMatchesItsSchemaAndHasTheLabsUnits) {
  const json report = write_fabric_fit(some_fit(measurements_of(R"({"area_density_g_m2": 150, "shear_N_m": 56})")));
  EXPECT_NO_THROW(validate_document("fabric_fit.schema.json", report)) << report.dump(2);
  EXPECT_NEAR(report["misfit"][0]["difference_percent"].get<double>(), 2, 1e-9);
  EXPECT_NEAR(report["misfit"][1]["measured"].get<double>(), 0.72 * 180 / std::numbers::pi, 1e-9);
  EXPECT_TRUE(report["parts"][0]["parameters"][0]["standard_error_percent"].is_null());
  EXPECT_NEAR(report["parts"][0]["parameters"][0]["value"].get<double>(), 3, 1e-9);
}

}  // namespace
}  // namespace toile
