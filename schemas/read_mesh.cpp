#include "engine/mesh/gltf.h"
#include "engine/mesh/obj.h"
#include "engine/scene/problem.h"
#include "schemas/pointer.h"
#include "schemas/scene_parts.h"

#include <nlohmann/json.hpp>

namespace toile {

namespace {

/// z up to y up, keeping the handedness: what faced −y faces +z.
Vec3 y_up(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

}  // namespace

TriangleMesh read_mesh_bytes(std::string_view bytes, const std::string& pointer, double unit, UpAxis up) {
  TriangleMesh mesh = bytes.substr(0, 4) == "glTF" ? read_glb(bytes, pointer) : read_obj(bytes, pointer);
  for (Vec3& vertex : mesh.vertices) vertex = unit * (up == UpAxis::z ? y_up(vertex) : vertex);
  return mesh;
}

TriangleMesh read_mesh(const nlohmann::json& source, const std::string& pointer, const Resolver& resolve) {
  const auto text = source.find("inline");
  const std::string bytes = text != source.end() ? text->get<std::string>() : resolve(source, pointer);
  return read_mesh_bytes(bytes, pointer, source.value("unit_mm", 1000.0) * 1e-3,
                         source.value("up", "y") == "z" ? UpAxis::z : UpAxis::y);
}

}  // namespace toile
