#include "schemas/read_measurements.h"

#include "schemas/fabrics.h"
#include "schemas/pointer.h"
#include "schemas/validate.h"

#include <nlohmann/json.hpp>
#include <numbers>

namespace toile {

namespace {

using nlohmann::json;

constexpr double kMillimetre = 1e-3, kPercent = 1e-2, kDegree = std::numbers::pi / 180;
constexpr double kPeirceAngle = 41.5 * kDegree;
constexpr const char* kDirections[] = {"warp", "weft", "bias"};

void set(const json& object, const char* key, double unit, double& value) {
  if (object.contains(key)) value = object[key].get<double>() * unit;
}

MeasuredPull read_pull(const json& document) {
  MeasuredPull test;
  set(document, "length_mm", kMillimetre, test.length);
  set(document, "width_mm", kMillimetre, test.width);
  set(document, "uncertainty_percent", kPercent, test.uncertainty);
  for (const json& reading : document.at("readings")) {
    const double force = reading.contains("force_N") ? reading["force_N"].get<double>() / test.width
                                                     : reading.at("force_N_m").get<double>();
    test.readings.push_back({reading.at("strain_percent").get<double>() * kPercent, force});
  }
  test.as_curve = document.value("model", test.readings.size() > 1 ? "curve" : "constant") == "curve";
  return test;
}

MeasuredCantilever read_cantilever(const json& document, const std::string& pointer) {
  const auto refuse = [&](const char* key, const char* detail) {
    if (document.contains(key)) throw InputError(child(pointer, key), "key_not_of_form", detail);
  };
  MeasuredCantilever test;
  set(document, "width_mm", kMillimetre, test.width);
  set(document, "uncertainty_percent", kPercent, test.uncertainty);
  test.value = kPeirceAngle;
  if (document.contains("bending_length_mm")) {
    refuse("angle_deg", "A bending length is that of an angle of 41.5°.");
    refuse("drop_mm", "A bending length is that of an angle of 41.5°.");
    test.overhang = 2 * kMillimetre * document["bending_length_mm"].get<double>();
    return test;
  }
  set(document, "overhang_mm", kMillimetre, test.overhang);
  set(document, "angle_deg", kDegree, test.value);
  if (document.contains("drop_mm")) {
    refuse("angle_deg", "Give either the angle or the drop.");
    test.reading = MeasuredCantilever::Reading::drop;
    set(document, "drop_mm", kMillimetre, test.value);
  }
  return test;
}

MeasuredLoop read_loop(const json& document) {
  MeasuredLoop test;
  set(document, "length_mm", kMillimetre, test.length);
  set(document, "width_mm", kMillimetre, test.width);
  set(document, "height_mm", kMillimetre, test.height);
  set(document, "uncertainty_percent", kPercent, test.uncertainty);
  return test;
}

}  // namespace

FabricMeasurements read_measurements(const json& document) {
  validate_document("measurements.schema.json", document);
  FabricMeasurements m;
  const json base = document.value("base", "poplin");
  m.base = read_fabric(base, "/base");
  m.base_stretch = stretch_test(*fabric_document(base.get<std::string>()));
  m.area_density = document.at("area_density_g_m2").get<double>() * 1e-3;
  if (document.contains("thickness_mm")) m.thickness = document["thickness_mm"].get<double>() * kMillimetre;
  if (document.contains("poisson_ratio")) m.poisson_ratio = document["poisson_ratio"].get<double>();
  if (document.contains("bias_extension")) m.pulls[2] = read_pull(document["bias_extension"]);
  if (document.contains("shear_N_m")) m.shear = {document["shear_N_m"].get<double>()};
  for (std::size_t d = 0; d < 3; ++d) {
    const auto visit = [&](const char* kind, const auto& read) {
      const auto section = document.find(kind);
      if (section == document.end() || !section->contains(kDirections[d])) return;
      read((*section)[kDirections[d]], child(child("", kind), kDirections[d]));
    };
    visit("uniaxial", [&](const json& test, const std::string&) { m.pulls[d] = read_pull(test); });
    visit("cantilever",
          [&](const json& test, const std::string& pointer) { m.cantilevers[d] = read_cantilever(test, pointer); });
    visit("pear_loop", [&](const json& test, const std::string&) { m.loops[d] = read_loop(test); });
    visit("bending_uN_m", [&](const json& value, const std::string&) { m.bending[d] = {value.get<double>() * 1e-6}; });
  }
  std::vector<Problem> problems = measurement_problems(m);
  if (!problems.empty()) throw InputError(std::move(problems));
  return m;
}

}  // namespace toile
