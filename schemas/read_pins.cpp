#include "engine/scene/problem.h"
#include "schemas/placement.h"
#include "schemas/pointer.h"
#include "schemas/scene_parts.h"

#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

namespace toile {

namespace {

using nlohmann::json;

std::set<std::string> edge_labels(const Pattern& pattern) {
  std::set<std::string> labels;
  for (const Panel& panel : pattern.panels) {
    for (const PatternEdge& edge : panel.edges) {
      if (!edge.label.empty()) labels.insert(edge.label);
    }
  }
  return labels;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Whether arms, a collar or a strapless top's own label carry the garment, so that it does not hang from its waist.
bool carried_above_waist(const Pattern& pattern, const std::set<std::string>& labels) {
  for (const Panel& panel : pattern.panels) {
    if (panel.label == "arm") return true;
  }
  for (const std::string& label : labels) {
    if (label == "strapless_top" || ends_with(label, "collar") || ends_with(label, "armhole")) return true;
  }
  return false;
}

std::set<std::string> automatic_labels(const Pattern& pattern) {
  const std::set<std::string> labels = edge_labels(pattern);
  std::set<std::string> held;
  if (labels.contains("strapless_top")) held.insert("strapless_top");
  if (labels.contains("lower_interface") && !carried_above_waist(pattern, labels)) held.insert("lower_interface");
  return held;
}

[[noreturn]] void no_body(const std::string& pointer) {
  throw InputError(pointer, "attached_without_body", "There is no body to be attached to.");
}

PinEdge read_edge(const json& edge, const Garment& garment, const std::string& pointer) {
  const auto name = edge.at("panel").get<std::string>();
  if (const auto* pattern = std::get_if<Pattern>(&garment.shape)) {
    for (std::size_t p = 0; p < pattern->panels.size(); ++p) {
      const Panel& panel = pattern->panels[p];
      if (panel.name != name) continue;
      const auto index = edge.at("edge").get<std::size_t>();
      if (index < panel.edges.size()) return PinEdge{static_cast<int>(p), static_cast<int>(index)};
      throw InputError(child(pointer, "edge"), "unknown_edge",
                       "The panel has " + std::to_string(panel.edges.size()) + " edges, counted from 0.");
    }
  }
  throw InputError(child(pointer, "panel"), "unknown_panel", "The garment has no panel \"" + name + "\".");
}

PinLabel read_label(const json& selection, const Garment& garment, const std::string& pointer) {
  const auto label = selection.at("label").get<std::string>();
  const auto* pattern = std::get_if<Pattern>(&garment.shape);
  if (!pattern || !edge_labels(*pattern).contains(label)) {
    throw InputError(child(pointer, "label"), "unknown_label", "No edge of the garment is labelled \"" + label + "\".");
  }
  return PinLabel{label};
}

PinMoved read_motion(const json& hold, const std::string& pointer) {
  PinMoved moved;
  moved.pivot = read_millimetres(hold, "pivot_mm");
  const json& frames = hold.at("key_frames");
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto time = frames[k].at("time_s").get<double>();
    if (k > 0 && time <= moved.key_frames.back().time) {
      throw InputError(child(child(child(pointer, "key_frames"), k), "time_s"), "times_not_rising",
                       "The times of key frames rise.");
    }
    moved.key_frames.push_back({time, read_millimetres(frames[k], "translate_mm"),
                                rotation_vector_from_degrees(read_vector(frames[k], "rotate_deg"))});
  }
  return moved;
}

}  // namespace

Selection read_selection(const json& pin, const Garment& garment, const std::string& pointer) {
  if (pin.contains("vertices")) return PinVertices{pin["vertices"].get<std::vector<int>>()};
  if (pin.contains("edge")) return read_edge(pin["edge"], garment, child(pointer, "edge"));
  if (pin.contains("nearest_mm")) return PinNearest{read_millimetres(pin, "nearest_mm")};
  if (pin.contains("box_mm")) {
    const Vec3 min = read_millimetres(pin["box_mm"], "min"), max = read_millimetres(pin["box_mm"], "max");
    if ((min.array() <= max.array()).all()) return PinBox{min, max};
    throw InputError(child(pointer, "box_mm"), "empty_box", "min lies above max along an axis.");
  }
  return read_label(pin, garment, pointer);
}

Pin read_pin(const json& document, const Garment& garment, const std::string& pointer, bool on_body) {
  Pin pin{read_selection(document, garment, pointer), PinFixed{}, document.value("clamp", false)};
  const auto hold = document.find("hold");
  const bool slides = hold != document.end() && *hold == "sliding";
  if (document.contains("friction") && !slides) {
    throw InputError(child(pointer, "friction"), "friction_of_nothing", "Only a pin whose hold is sliding rubs.");
  }
  if (hold == document.end() || *hold == "fixed") return pin;
  if (hold->is_object()) {
    pin.hold = read_motion(*hold, child(pointer, "hold"));
  } else {
    if (!on_body) no_body(child(pointer, "hold"));
    PinAttached attached;
    attached.slides = slides;
    if (document.contains("friction")) attached.friction = document["friction"].get<double>();
    pin.hold = attached;
  }
  return pin;
}

Fold read_fold(const json& document, const Garment& garment, const std::string& pointer) {
  Fold fold;
  if (document.contains("vertices")) {
    const auto* mesh = std::get_if<GarmentMesh>(&garment.shape);
    const auto count = mesh ? mesh->mesh.vertices.size() : 0;
    const auto vertices = document["vertices"].get<std::vector<int>>();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (static_cast<std::size_t>(vertices[k]) < count) continue;
      throw InputError(child(child(pointer, "vertices"), k), "vertex_out_of_range",
                       mesh ? "The mesh has " + std::to_string(count) + " vertices, counted from 0."
                            : "Only a garment that is a mesh has vertices to name.");
    }
    fold.select = PinVertices{vertices};
  } else if (document.contains("edge")) {
    fold.select = read_edge(document["edge"], garment, child(pointer, "edge"));
  } else {
    fold.select = read_label(document, garment, pointer);
  }
  fold.angle = document.at("angle_deg").get<double>() * std::numbers::pi / 180;
  fold.stiffness_factor = document.value("bending_factor", 1.0);
  return fold;
}

std::vector<Pin> attached_pins(const json& garment, const Pattern& pattern, const std::string& pointer, bool on_body) {
  const json attach = garment.value("attach", json("auto"));
  std::set<std::string> labels;
  if (attach.is_array()) {
    const std::set<std::string> known = edge_labels(pattern);
    for (std::size_t k = 0; k < attach.size(); ++k) {
      const auto label = attach[k].get<std::string>();
      if (!on_body) no_body(child(child(pointer, "attach"), k));
      if (!known.contains(label)) {
        throw InputError(child(child(pointer, "attach"), k), "unknown_label",
                         "No edge of the garment is labelled \"" + label + "\".");
      }
      labels.insert(label);
    }
  } else if (attach == "auto" && on_body) {
    labels = automatic_labels(pattern);
  }
  for (const json& pin : garment.value("pins", json::array())) labels.erase(pin.value("label", ""));
  std::vector<Pin> pins;
  for (const std::string& label : labels) pins.push_back({PinLabel{label}, PinAttached{}, false});
  return pins;
}

}  // namespace toile
