#include "schemas/fabrics.h"

#include "schemas/resource.h"
#include "schemas/validate.h"
#include "tests/schemas/files.h"

#include <gmock/gmock.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace toile {
namespace {

using nlohmann::json;

class Fabrics : public ::testing::TestWithParam<std::string> {};

TEST_P(Fabrics, AreCompleteAndSayWhereTheyComeFrom) {
  const json document = *fabric_document(GetParam());
  validate_document("fabric.schema.json", document);
  const json schema = json::parse(resource("fabric.schema.json"));
  const std::set<std::string> without_default{"stretch_curve"};  // optional all the same
  for (const auto& [key, property] : schema["properties"].items()) {
    if (!property.contains("default") && !without_default.contains(key)) {
      EXPECT_TRUE(document.contains(key)) << key;
    }
  }
  EXPECT_EQ(document["name"], GetParam());
}

TEST_P(Fabrics, CanBeSimulated) {
  const Fabric f = read_fabric(GetParam());
  EXPECT_LT(f.poisson_stiffness * f.poisson_stiffness, f.stretch_stiffness.warp * f.stretch_stiffness.weft);
  EXPECT_GT(f.area_density, 0.03);
  EXPECT_LT(f.area_density, 0.6);
  // Hanging from its edge, two metres of it stretch by less than a tenth.
  EXPECT_LT(f.area_density * 9.81 * 2, 0.1 * f.stretch_stiffness.weft);
}

std::vector<std::string> typical_fabric_names() {
  std::vector<std::string> names = fabric_names();
  std::erase_if(names, [](const std::string& name) { return (*fabric_document(name))["provenance"] != "typical"; });
  return names;
}

class TypicalFabrics : public ::testing::TestWithParam<std::string> {};

TEST_P(TypicalFabrics, LieWithinThePercentilesOfRealCloth) {
  const Fabric f = read_fabric(GetParam());
  // Feng et al. 2022, 5th and 95th percentile of 251 fabrics.
  EXPECT_GE(f.area_density, 0.0411);
  EXPECT_LE(f.area_density, 0.4869);
  EXPECT_GE(f.bending_stiffness.warp, 1.162e-6);
  EXPECT_LE(f.bending_stiffness.warp, 106.5e-6);
  EXPECT_GE(f.bending_stiffness.weft, 0.9776e-6);
  EXPECT_LE(f.bending_stiffness.weft, 51.36e-6);
  EXPECT_GE(f.bending_stiffness.bias, 1.111e-6);
  EXPECT_LE(f.bending_stiffness.bias, 62.52e-6);
}

INSTANTIATE_TEST_SUITE_P(Library, TypicalFabrics, ::testing::ValuesIn(typical_fabric_names()),
                         [](const auto& fabric) { return fabric.param; });

INSTANTIATE_TEST_SUITE_P(Library, Fabrics, ::testing::ValuesIn(fabric_names()),
                         [](const auto& fabric) { return fabric.param; });

TEST(FabricLibrary, HoldsSixMeasuredAndADozenTypicalOnes) {
  int measured = 0, typical = 0;
  for (const std::string& name : fabric_names()) {
    const json document = *fabric_document(name);
    (document["provenance"] == "measured" ? measured : typical) += 1;
  }
  EXPECT_EQ(measured, 6);
  EXPECT_GE(typical, 12);
}

TEST(FabricLibrary, MeasuredValuesAreThoseOfTheSource) {
  const std::filesystem::path references = TOILE_SHARED "/validation/references.json";
  if (!std::filesystem::exists(references)) GTEST_SKIP() << "needs ../shared";
  const json rows = testing::json_from(references)["fabrics_measured"]["rows"];
  const std::vector<std::string> names{"suiting_polyester_twill",          "suiting_polyester_plain",
                                       "suiting_wool_blend_twill",         "suiting_polyester_viscose_twill",
                                       "suiting_polyester_elastane_plain", "suiting_cotton_polyester_twill"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Fabric f = read_fabric(names[k]);
    EXPECT_NEAR(f.area_density * 1e3, rows[k]["g_m2"].get<double>(), 1e-9);
    EXPECT_NEAR(f.thickness * 1e3, rows[k]["thickness_mm"].get<double>(), 1e-9);
    EXPECT_NEAR(f.stretch_stiffness.bias, rows[k]["shear_N_m"].get<double>(), 1e-9);
    EXPECT_NEAR(f.bending_stiffness.warp * 1e6, rows[k]["B_warp_weft_uNm"][0].get<double>(), 1e-9);
    EXPECT_NEAR(f.bending_stiffness.weft * 1e6, rows[k]["B_warp_weft_uNm"][1].get<double>(), 1e-9);
    // Peirce's bending length, which the source gives beside it.
    const double c = std::cbrt(f.bending_stiffness.warp / (f.area_density * 9.81));
    EXPECT_NEAR(c * 1e3, rows[k]["c_mm"][0].get<double>(), 0.02 * c * 1e3) << names[k];
  }
}

TEST(FabricLibrary, UnknownNamesAreAnsweredWithTheKnownOnes) {
  EXPECT_FALSE(fabric_document("kevlar").has_value());
  EXPECT_FALSE(fabric_document("../scene.schema").has_value());
  const auto problems = testing::problems_of([] { read_fabric("kevlar", "/garments/0/fabric"); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0].detail, ::testing::HasSubstr("denim"));
  EXPECT_EQ(testing::problems_of([] { read_fabric({{"base", "kevlar"}}, "/f"); })[0].pointer, "/f/base");
}

}  // namespace
}  // namespace toile
