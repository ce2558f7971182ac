#include "schemas/pointer.h"
#include "schemas/scene_parts.h"

#include <nlohmann/json.hpp>

namespace toile {

namespace {

using nlohmann::json;

/// Calls read(element, its pointer) for the list at `key`.
template <typename Read>
void for_each_element(const json& document, const char* key, const std::string& pointer, Read read) {
  const auto found = document.find(key);
  if (found == document.end()) return;
  for (std::size_t k = 0; k < found->size(); ++k) read((*found)[k], child(child(pointer, key), k));
}

void read_zippers(const json& document, const std::string& pointer, Garment& garment) {
  for_each_element(document, "zippers", pointer, [&](const json& element, const std::string& here) {
    Zipper zipper;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string side = child(child(here, "sides"), k);
      const Selection selection = read_selection(element.at("sides")[k], garment, side);
      if (const auto* edge = std::get_if<PinEdge>(&selection)) {
        zipper.sides[k] = *edge;
      } else {
        zipper.sides[k] = std::get<PinVertices>(selection);
      }
    }
    const auto read_end = [&](const char* key, ZipperEnd& end) {
      const json given = element.value(key, json::object());
      end.size = read_vector(given, "size_mm", end.size * 1e3) * 1e-3;
      end.mass = given.value("mass_g", end.mass * 1e3) * 1e-3;
    };
    zipper.from_end = element.value("bottom", "start") == "end";
    zipper.closed_fraction = element.value("closed_percent", zipper.closed_fraction * 1e2) * 1e-2;
    zipper.mass_per_length = element.value("mass_g_m", zipper.mass_per_length * 1e3) * 1e-3;
    zipper.stiffness = element.value("stiffness_N", zipper.stiffness);
    zipper.bending = element.value("bending_N_mm2", zipper.bending * 1e6) * 1e-6;
    zipper.damping = element.value("damping_s", zipper.damping);
    read_end("slider", zipper.slider);
    read_end("stops", zipper.stop);
    zipper.thread_stiffness = element.value("thread_stiffness_N_m", zipper.thread_stiffness);
    zipper.thread_damping = element.value("thread_damping_s", zipper.thread_damping);
    zipper.friction = element.value("friction", zipper.friction);
    garment.zippers.push_back(std::move(zipper));
  });
}

/// What an elastic and a drawcord have in common: the line that they run along, and how they resist a pull.
template <typename Cord>
Cord read_cord(const json& element, const Garment& garment, const std::string& pointer) {
  Cord cord;
  cord.select = read_selection(element, garment, pointer);
  cord.stiffness = element.value("stiffness_N", cord.stiffness);
  cord.damping = element.value("damping_s", cord.damping);
  return cord;
}

}  // namespace

void read_trims(const json& document, const std::string& pointer, Garment& garment) {
  for_each_element(document, "elastics", pointer, [&](const json& element, const std::string& here) {
    Elastic elastic = read_cord<Elastic>(element, garment, here);
    elastic.length_factor = element.at("length_percent").get<double>() * 1e-2;
    garment.elastics.push_back(std::move(elastic));
  });
  for_each_element(document, "drawcords", pointer, [&](const json& element, const std::string& here) {
    Drawcord cord = read_cord<Drawcord>(element, garment, here);
    cord.length = element.at("length_mm").get<double>() * 1e-3;
    garment.drawcords.push_back(std::move(cord));
  });
  for_each_element(document, "trims", pointer, [&](const json& element, const std::string&) {
    Trim trim;
    const json& button = element.at("button");
    trim.button.diameter = button.value("diameter_mm", trim.button.diameter * 1e3) * 1e-3;
    trim.button.thickness = button.value("thickness_mm", trim.button.thickness * 1e3) * 1e-3;
    trim.button.mass = button.value("mass_g", trim.button.mass * 1e3) * 1e-3;
    for (const json& hole : element.at("attach")) {
      const json& at = hole.at("at_mm");
      trim.holes.push_back(
          {hole.at("panel").get<std::string>(), Vec2(at[0].get<double>() * 1e-3, at[1].get<double>() * 1e-3)});
    }
    trim.stiffness = element.value("stiffness_N_m", trim.stiffness);
    trim.damping = element.value("damping_s", trim.damping);
    trim.friction = element.value("friction", trim.friction);
    garment.trims.push_back(std::move(trim));
  });
  read_zippers(document, pointer, garment);
}

}  // namespace toile
