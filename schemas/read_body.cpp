#include "engine/scene/problem.h"
#include "schemas/placement.h"
#include "schemas/pointer.h"
#include "schemas/scene_parts.h"

#include <nlohmann/json.hpp>

namespace toile {

namespace {

using nlohmann::json;

double metres(const json& object, const char* key) { return object.at(key).get<double>() * 1e-3; }

template <typename SweptSegment>
SweptSegment read_segment(const json& shape, const std::string& pointer) {
  SweptSegment segment;
  segment.start = read_millimetres(shape, "start_mm");
  segment.end = read_millimetres(shape, "end_mm");
  segment.radius = metres(shape, "radius_mm");
  if (segment.start == segment.end) {
    throw InputError(child(pointer, "end_mm"), "zero_length", "The shape starts and ends at the same point.");
  }
  return segment;
}

PlaneBody read_plane(const json& shape, const std::string& pointer) {
  const Vec3 normal = read_vector(shape, "normal", Vec3::UnitY());
  if (normal.norm() == 0) throw InputError(child(pointer, "normal"), "zero_length", "A normal has a direction.");
  return {read_millimetres(shape, "point_mm"), normal.normalized()};
}

DressFormBody read_dress_form(const json& shape) {
  DressFormBody form;
  const auto set = [&](double& value, const char* key) {
    if (shape.contains(key)) value = metres(shape, key);
  };
  set(form.height, "height_mm");
  set(form.bust, "bust_mm");
  set(form.waist, "waist_mm");
  set(form.hip, "hip_mm");
  set(form.shoulder_width, "shoulder_width_mm");
  set(form.neck, "neck_mm");
  return form;
}

decltype(Body::shape) read_shape(const json& body, const std::string& pointer, const Resolver& resolve) {
  if (body.contains("mesh")) return MeshBody{read_mesh(body["mesh"], child(pointer, "mesh"), resolve)};
  if (body.contains("sphere")) {
    const json& shape = body["sphere"];
    return SphereBody{read_millimetres(shape, "center_mm"), metres(shape, "radius_mm")};
  }
  if (body.contains("capsule")) return read_segment<CapsuleBody>(body["capsule"], child(pointer, "capsule"));
  if (body.contains("cylinder")) return read_segment<CylinderBody>(body["cylinder"], child(pointer, "cylinder"));
  if (body.contains("box")) {
    const json& shape = body["box"];
    return BoxBody{read_millimetres(shape, "center_mm"), 0.5 * read_millimetres(shape, "size_mm"),
                   rotation_from_degrees(read_vector(shape, "rotate_deg"))};
  }
  if (body.contains("plane")) return read_plane(body["plane"], child(pointer, "plane"));
  return read_dress_form(body.at("dress_form"));
}

}  // namespace

Body read_body(const json& document, const std::string& pointer, const Resolver& resolve) {
  Body body{read_shape(document, pointer, resolve), std::nullopt};
  if (document.contains("friction")) body.friction = document["friction"].get<double>();
  return body;
}

}  // namespace toile
