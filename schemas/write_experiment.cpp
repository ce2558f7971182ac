#include "schemas/write_experiment.h"

#include <nlohmann/json.hpp>
#include <numbers>

namespace toile {

namespace {

using nlohmann::json;

constexpr double kDegrees = 180 / std::numbers::pi;

json document(const CusickReport& report) {
  json starts = json::array();
  for (const CusickStart& start : report.starts) {
    json amplitudes = json::array();
    for (const double amplitude : start.node_amplitudes) amplitudes.push_back(1e3 * amplitude);
    starts.push_back({{"at_rest", start.at_rest},
                      {"drape_coefficient_percent", 100 * start.coefficient},
                      {"nodes", start.nodes},
                      {"node_amplitudes_mm", std::move(amplitudes)},
                      {"energy_mJ", 1e3 * start.energy}});
  }
  return {
      {"drape_coefficient_percent", 100 * report.coefficient}, {"nodes", report.nodes}, {"starts", std::move(starts)}};
}

json document(const CantileverReport& report) {
  json result = {
      {"overhang_mm", 1e3 * report.overhang}, {"angle_deg", kDegrees * report.angle}, {"drop_mm", 1e3 * report.drop}};
  if (report.bending_length) result["bending_length_mm"] = 1e3 * *report.bending_length;
  return result;
}

json document(const UniaxialReport& report) {
  json curve = json::array();
  for (const UniaxialReport::Reading& reading : report.curve)
    curve.push_back({{"strain_percent", 100 * reading.strain}, {"force_N_m", reading.force}});
  return {{"curve", std::move(curve)}, {"shear_angle_deg", kDegrees * report.shear_angle}};
}

json document(const PearLoopReport& report) { return {{"height_mm", 1e3 * report.height}}; }

}  // namespace

json write_experiment(const ExperimentReport& report) {
  return std::visit([](const auto& part) { return document(part); }, report);
}

}  // namespace toile
