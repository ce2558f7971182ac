#include "engine/scene/problem.h"
#include "schemas/read_scene.h"
#include "schemas/validate.h"
#include "schemas/write_experiment.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;

Experiment experiment_from(const char* text) { return read_experiment(parse_json(text)); }

TEST(ReadExperiment, KeysBecomeMetresAndDirections) {
  const auto disc = std::get<CusickDrape>(experiment_from(
      R"({"experiment": {"kind": "cusick_drape", "fabric": "denim", "disc_mm": 360, "support_mm": 200, "starts": 2,
                        "lowering_s": 3}})"));
  EXPECT_EQ(disc.fabric.name, "denim");
  EXPECT_DOUBLE_EQ(disc.disc_diameter, 0.36);
  EXPECT_DOUBLE_EQ(disc.support_diameter, 0.2);
  EXPECT_EQ(disc.starts, 2);
  EXPECT_DOUBLE_EQ(disc.lowering_time, 3);
  const auto strip = std::get<Cantilever>(experiment_from(
      R"({"experiment": {"kind": "cantilever", "fabric": "denim", "direction": "bias", "overhang_mm": 80}})"));
  EXPECT_EQ(strip.direction, Direction::bias);
  EXPECT_DOUBLE_EQ(*strip.overhang, 0.08);
  const auto pulled = std::get<UniaxialTest>(experiment_from(
      R"({"experiment": {"kind": "bias_extension", "fabric": "denim", "strains_percent": [2, 4], "length_mm": 150}})"));
  EXPECT_EQ(pulled.direction, Direction::bias);
  EXPECT_DOUBLE_EQ(pulled.length, 0.15);
  EXPECT_THAT(pulled.strains, ::testing::ElementsAre(::testing::DoubleEq(0.02), ::testing::DoubleEq(0.04)));
  const auto loop = std::get<PearLoop>(
      experiment_from(R"({"experiment": {"kind": "pear_loop", "fabric": "denim", "length_mm": 200}})"));
  EXPECT_DOUBLE_EQ(loop.length, 0.2);
  EXPECT_EQ(loop.direction, Direction::warp);
}

TEST(ReadExperiment, SchemasDefaultsAreTheStructs) {
  const json keys = bundled_schema("experiment.schema.json")["properties"]["experiment"]["properties"];
  const CusickDrape disc;
  EXPECT_DOUBLE_EQ(keys["disc_mm"]["default"].get<double>(), 1e3 * disc.disc_diameter);
  EXPECT_DOUBLE_EQ(keys["support_mm"]["default"].get<double>(), 1e3 * disc.support_diameter);
  EXPECT_EQ(keys["starts"]["default"], disc.starts);
  EXPECT_DOUBLE_EQ(keys["lowering_s"]["default"].get<double>(), disc.lowering_time);
  std::vector<double> percent;
  for (const double strain : UniaxialTest{}.strains) percent.push_back(100 * strain);
  EXPECT_THAT(keys["strains_percent"]["default"].get<std::vector<double>>(),
              ::testing::Pointwise(::testing::DoubleNear(1e-12), percent));
}

TEST(ReadExperiment, EveryResultMatchesItsSchema) {
  const CusickReport cusick{0.3, 7.5, {{true, 0.3, 7, -1e-3, {1e-3, 2e-3}}}};
  const UniaxialReport uniaxial{{{0.01, 5}, {0.02, 11}}, 0.1};
  for (const ExperimentReport& report : std::vector<ExperimentReport>{
           cusick, CantileverReport{0.04, 0.7, 0.02}, CantileverReport{0.04, 0.5, {}}, uniaxial, PearLoopReport{0.06}})
    EXPECT_NO_THROW(validate_document("experiment_result.schema.json", write_experiment(report)))
        << write_experiment(report);
  EXPECT_DOUBLE_EQ(write_experiment(cusick)["starts"][0]["node_amplitudes_mm"][1].get<double>(), 2.0);
  EXPECT_FALSE(write_experiment(CantileverReport{0.04, 0.5, {}}).contains("bending_length_mm"));
}

}  // namespace
}  // namespace toile
