#include "schemas/write_fabric_fit.h"

#include "schemas/fabrics.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace toile {

namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 64;  // fabric.schema.json

json directional(const Directional& values, double unit) {
  return {{"warp", values.warp / unit}, {"weft", values.weft / unit}, {"bias", values.bias / unit}};
}

json readings(const std::vector<ForceStrain>& curve) {
  json list = json::array();
  for (const ForceStrain& r : curve) list.push_back({{"strain_percent", 100 * r.strain}, {"force_N_m", r.force}});
  return list;
}

std::string source_of(const FabricFit& fit, const std::string& base) {
  std::string text = "Fitted by toile " TOILE_VERSION " to measurements of one cloth. From " + base + ":";
  for (const std::string& key : fit.kept) text.append(" ").append(key, 1);
  return text.append(".");
}

json document(const MisfitRow& row) {
  const FitUnit unit = unit_of(row.quantity);
  json result = {{"measurement", row.pointer},
                 {"quantity", unit.key},
                 {"measured", row.measured / unit.size},
                 {"fitted", row.fitted / unit.size},
                 {"difference", (row.fitted - row.measured) / unit.size},
                 {"difference_percent", 100 * (row.fitted / row.measured - 1)},
                 {"uncertainty_percent", 100 * row.uncertainty}};
  if (row.strain) result["strain_percent"] = 100 * *row.strain;
  return result;
}

json document(const ParameterEstimate& e) {
  json result = {{"key", e.pointer}, {"value", e.value / unit_of(e).size}, {"determined", e.determined}};
  result["standard_error_percent"] = std::isfinite(e.standard_error) ? json(100 * e.standard_error) : json();
  if (e.strain) result["strain_percent"] = 100 * *e.strain;
  return result;
}

json document(const FitPart& part);

template <class List>
json documents(const List& list) {
  json array = json::array();
  for (const auto& item : list) array.push_back(document(item));
  return array;
}

json document(const FitPart& part) {
  return {{"part", part.name},
          {"parameters", documents(part.parameters)},
          {"singular_values", part.singular_values},
          {"iterations", part.iterations},
          {"corrections", part.corrections},
          {"converged", part.converged},
          {"stop_reason", part.stop_reason}};
}

}  // namespace

FitUnit unit_of(MisfitRow::Quantity quantity) {
  switch (quantity) {
    case MisfitRow::Quantity::force:
      return {"force_N_m", "N/m", 1};
    case MisfitRow::Quantity::angle:
      return {"angle_deg", "deg", std::numbers::pi / 180};
    case MisfitRow::Quantity::drop:
      return {"drop_mm", "mm", 1e-3};
    case MisfitRow::Quantity::height:
      return {"height_mm", "mm", 1e-3};
    case MisfitRow::Quantity::bending:
      return {"bending_uN_m", "uN m", 1e-6};
    case MisfitRow::Quantity::shear:
      return {"shear_N_m", "N/m", 1};
  }
  return {"", "", 1};
}

FitUnit unit_of(const ParameterEstimate& parameter) {
  const bool bending = parameter.pointer.rfind("/bending_uN_m/", 0) == 0;
  return unit_of(bending ? MisfitRow::Quantity::bending : MisfitRow::Quantity::force);
}

json write_fabric(const FabricFit& fit, const json& measurements) {
  const std::string base = measurements.value("base", "poplin");
  json result = fabric_document(base).value();
  for (const char* of_another_cloth : {"composition", "description", "licence", "stretch_curve"})
    result.erase(of_another_cloth);
  const Fabric& f = fit.fabric;
  result["base"] = base;
  result["name"] = measurements.value("name", (base + ", fitted").substr(0, kLongestName));
  result["provenance"] = "measured";
  result["source"] = source_of(fit, base);
  for (const char* key : {"description", "composition", "woven", "area_density_g_m2", "thickness_mm", "poisson_ratio"})
    if (measurements.contains(key)) result[key] = measurements[key];
  result["stretch_N_m"] = directional(f.stretch_stiffness, 1);
  if (!fit.stretch.warp.empty()) result["stretch_curve"]["warp"] = readings(fit.stretch.warp);
  if (!fit.stretch.weft.empty()) result["stretch_curve"]["weft"] = readings(fit.stretch.weft);
  if (!fit.stretch.bias.empty()) result["stretch_curve"]["bias"] = readings(fit.stretch.bias);
  result["bending_uN_m"] = directional(f.bending_stiffness, 1e-6);
  return result;
}

json write_fabric_fit(const FabricFit& fit) {
  return {{"version", TOILE_VERSION},
          {"status", fit.status},
          {"stop_reason", fit.stop_reason},
          {"misfit", documents(fit.misfit)},
          {"rms_percent", 100 * fit.rms},
          {"rms_over_uncertainty", fit.rms_over_uncertainty},
          {"parts", documents(fit.parts)},
          {"kept", fit.kept},
          {"warnings", fit.warnings},
          {"simulations", fit.simulations},
          {"time_s", fit.time}};
}

}  // namespace toile
