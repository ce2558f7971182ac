#include "engine/scene/problem.h"
#include "schemas/problem.h"
#include "schemas/read_scene.h"
#include "schemas/validate.h"
#include "tests/schemas/files.h"

#include <gmock/gmock.h>
#include <algorithm>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kExamples = TOILE_SOURCE "/schemas/examples";

Job read_file(const fs::path& path) {
  return read_scene(parse_json(testing::bytes_of(path)), file_resolver(path.parent_path()));
}

std::vector<std::string> examples(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kExamples / folder)) {
    const std::string name = entry.path().stem().string();
    if (name.find(".problem") == std::string::npos) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ValidExamples : public ::testing::TestWithParam<std::string> {};

TEST_P(ValidExamples, AreRead) {
  const Job job = read_file(kExamples / "valid" / (GetParam() + ".json"));
  EXPECT_EQ(job.scene.garments.empty(), job.experiment.has_value()) << "a scene or an experiment";
  EXPECT_FALSE(job.render.views.empty());
}

class InvalidExamples : public ::testing::TestWithParam<std::string> {};

TEST_P(InvalidExamples, GetTheirProblem) {
  const json expected = testing::json_from(kExamples / "invalid" / (GetParam() + ".problem.json"));
  validate_document("problem.schema.json", expected);
  try {
    read_file(kExamples / "invalid" / (GetParam() + ".json"));
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_EQ(problem_document(error), expected) << problem_document(error).dump(2);
  }
}

std::string name_of(const ::testing::TestParamInfo<std::string>& example) { return example.param; }
INSTANTIATE_TEST_SUITE_P(All, ValidExamples, ::testing::ValuesIn(examples("valid")), name_of);
INSTANTIATE_TEST_SUITE_P(All, InvalidExamples, ::testing::ValuesIn(examples("invalid")), name_of);

TEST(ValidExamples, SayingEveryDefaultChangesNothing) {
  const Job said = read_file(kExamples / "valid" / "every_default_said.json");
  const Job silent = read_scene(parse_json(R"({"garments": [{"rectangle": {"width_mm": 1, "height_mm": 1}}]})"), {});
  EXPECT_EQ(said.scene.fidelity, silent.scene.fidelity);
  EXPECT_EQ(said.scene.garments[0].fabric.name, silent.scene.garments[0].fabric.name);
  EXPECT_DOUBLE_EQ(said.scene.garments[0].edge_length, silent.scene.garments[0].edge_length);
}

}  // namespace
}  // namespace toile
