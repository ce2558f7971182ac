#include "schemas/write_report.h"

#include "engine/scene/problem.h"
#include "schemas/problem.h"
#include "schemas/validate.h"

#include <gmock/gmock.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;

Report full_report() {
  Report report;
  report.status = "converged";
  report.stop_reason = "at_rest";
  report.vertices = 30000;
  report.triangles = 59000;
  report.time = {1, 2, 3, 6.5, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  report.simulated_time = 1.25;
  report.stretch_warp = {0.001, 0.02, 0.05};
  report.stretch_bias = {0.01, 0.03, 0.06, -0.04, -0.02, 0.005};
  report.compressed_share = 0.002;
  report.energies = {{"membrane", 0.001}, {"bending", 0.002}, {"gravity", -0.3}};
  report.contacts = {40, 0, 30, 0};
  report.discretisation_error = 0.0015;
  report.residual_rms = 0.01;
  report.penetration_max = 0.0012;
  report.seam_gap_max = 0.0003;
  report.self_intersections = 2;
  report.kinetic_energy = 1e-7;
  report.result_sha256 = std::string(64, 'a');
  report.warnings = {"a garment of 17 m"};
  return report;
}

TEST(WriteReport, MatchesItsSchema) {
  EXPECT_NO_THROW(validate_document("report.schema.json", write_report(full_report())));
  Report empty;
  empty.status = "failed";
  EXPECT_NO_THROW(validate_document("report.schema.json", write_report(empty)));
}

TEST(WriteReport, NamesInWarningsMayHoldAnyBytes) {
  Report report = full_report();
  report.warnings = {"panel 'K\xF6rper' bends soft"};
  EXPECT_NE(write_report(report).dump().find("K\xEF\xBF\xBDrper"), std::string::npos);
}

TEST(WriteReport, HasTheUnitsOfItsKeys) {
  const json document = write_report(full_report());
  EXPECT_DOUBLE_EQ(document["stretch_percent"]["warp"]["p99"], 2.0);
  EXPECT_DOUBLE_EQ(document["stretch_percent"]["bias"]["min"], -4.0);
  EXPECT_DOUBLE_EQ(document["stretch_percent"]["bias"]["p01"], -2.0);
  EXPECT_DOUBLE_EQ(document["stretch_percent"]["bias"]["median"], 0.5);
  EXPECT_DOUBLE_EQ(document["compressed_percent"], 0.2);
  EXPECT_DOUBLE_EQ(document["energy_j"]["gravity"], -0.3);
  EXPECT_EQ(document["contacts"]["body"]["count"], 40);
  EXPECT_DOUBLE_EQ(document["contacts"]["body"]["sticking_share"], 0.75);
  EXPECT_DOUBLE_EQ(document["contacts"]["cloth"]["sticking_share"], 0);
  EXPECT_DOUBLE_EQ(document["discretisation_error_mm"], 1.5);
  EXPECT_DOUBLE_EQ(document["penetration_mm"]["max"], 1.2);
  EXPECT_DOUBLE_EQ(document["seam_gap_mm"]["max"], 0.3);
  EXPECT_DOUBLE_EQ(document["time_s"]["total"], 6.5);
  EXPECT_DOUBLE_EQ(document["time_s"]["stages"]["line_search"], 0.5);
  EXPECT_EQ(document["self_intersections"], 2);
}

TEST(WriteReport, RefusesNumbersThatAreNone) {
  Report report = full_report();
  report.stretch_weft.max = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_report(report), std::domain_error);
  report = full_report();
  report.kinetic_energy = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_report(report), std::domain_error);
}

TEST(ProblemDocument, MatchesItsSchema) {
  const InputError error({{"/garments/0/x", "unknown_key", "no x"}, {"/body", "wrong_type", "no body"}});
  const json document = problem_document(error);
  EXPECT_NO_THROW(validate_document("problem.schema.json", document));
  EXPECT_EQ(document["status"], 422);
  EXPECT_EQ(document["errors"].size(), 2u);
  EXPECT_NO_THROW(validate_document("problem.schema.json", problem_document(404, "There is no job 7.")));
  EXPECT_EQ(problem_document(404, "")["title"], "Not Found");
}

TEST(ProblemDocument, IsWritableWhateverTheBytes) {
  const json document = problem_document(InputError("/\xff", "unknown_key", "a\xc0\xaf"));
  EXPECT_NO_THROW(document.dump());
}

TEST(ProblemDocument, StatusSaysHowFarItCame) {
  EXPECT_EQ(problem_document(InputError("", "json_syntax", "x"))["status"], 400);
  EXPECT_EQ(problem_document(InputError("", "json_too_large", "x"))["status"], 413);
  EXPECT_EQ(problem_document(InputError("/body", "empty_body", "x"))["status"], 422);
}

}  // namespace
}  // namespace toile
