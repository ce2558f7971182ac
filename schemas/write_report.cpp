#include "schemas/write_report.h"

#include "schemas/problem.h"

#include "schemas/write_experiment.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace toile {

namespace {

using nlohmann::json;

json stretch_percent(const StretchStatistics& ratio) {
  return {{"mean", 100 * ratio.mean},     {"min", 100 * ratio.min}, {"p01", 100 * ratio.p01},
          {"median", 100 * ratio.median}, {"p99", 100 * ratio.p99}, {"max", 100 * ratio.max}};
}

json energies(const std::vector<TermEnergy>& terms) {
  json document = json::object();
  for (const TermEnergy& term : terms) document[term.term] = term.energy;
  return document;
}

json contacts(long count, long sticking) {
  const double share = count > 0 ? static_cast<double>(sticking) / static_cast<double>(count) : 0;
  return {{"count", count}, {"sticking_share", share}};
}

json times(const StageTimes& time) {
  return {{"assemble", time.assemble},
          {"drape", time.drape},
          {"render", time.render},
          {"total", time.total},
          {"stages",
           {{"collisions", time.collisions},
            {"derivatives", time.derivatives},
            {"assembly", time.assembly},
            {"linear_solve", time.linear_solve},
            {"line_search", time.line_search},
            {"other", time.other}}}};
}

void require_finite(const json& document) {
  const json leaves = document.flatten();
  for (const auto& [pointer, leaf] : leaves.items()) {
    if (leaf.is_number_float() && !std::isfinite(leaf.get<double>())) {
      throw std::domain_error("the report's " + pointer + " is not finite");
    }
  }
}

}  // namespace

json write_report(const Report& report) {
  json warnings = json::array();
  for (const std::string& warning : report.warnings) warnings.push_back(utf8(warning));
  json document = {{"status", report.status},
                   {"stop_reason", report.stop_reason},
                   {"vertices", report.vertices},
                   {"triangles", report.triangles},
                   {"time_s", times(report.time)},
                   {"simulated_time_s", report.simulated_time},
                   {"steps", report.steps},
                   {"newton_iterations", report.newton_iterations},
                   {"cg_iterations", report.cg_iterations},
                   {"splits", report.splits},
                   {"limited_vertices", report.limited_vertices},
                   {"stretch_percent",
                    {{"warp", stretch_percent(report.stretch_warp)},
                     {"weft", stretch_percent(report.stretch_weft)},
                     {"bias", stretch_percent(report.stretch_bias)}}},
                   {"compressed_percent", 100 * report.compressed_share},
                   {"energy_j", energies(report.energies)},
                   {"contacts",
                    {{"body", contacts(report.contacts.body, report.contacts.body_sticking)},
                     {"cloth", contacts(report.contacts.cloth, report.contacts.cloth_sticking)}}},
                   {"discretisation_error_mm", 1e3 * report.discretisation_error},
                   {"force_residual", {{"rms", report.residual_rms}, {"max", report.residual_max}}},
                   {"penetration_mm", {{"max", 1e3 * report.penetration_max}}},
                   {"self_intersections", report.self_intersections},
                   {"seam_gap_mm", {{"max", 1e3 * report.seam_gap_max}}},
                   {"kinetic_energy_j", report.kinetic_energy},
                   {"result_sha256", report.result_sha256},
                   {"warnings", warnings},
                   {"version", TOILE_VERSION}};
  if (report.experiment) document["experiment"] = write_experiment(*report.experiment);
  require_finite(document);
  return document;
}

}  // namespace toile
