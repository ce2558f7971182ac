#include "engine/mesh/gltf.h"
#include "engine/mesh/obj.h"
#include "engine/scene/problem.h"
#include "schemas/pointer.h"
#include "schemas/scene_parts.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace toile {

namespace {

/// z up to y up, keeping the handedness: what faced −y faces +z.
Vec3 y_up(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }

TriangleMesh parse_mesh(const std::string& bytes, const std::string& pointer) {
  if (std::string_view(bytes).substr(0, 4) == "glTF") return read_glb(bytes, pointer);
  return read_obj(bytes, pointer);
}

}  // namespace

TriangleMesh read_mesh(const nlohmann::json& source, const std::string& pointer, const Resolver& resolve) {
  const auto text = source.find("inline");
  TriangleMesh mesh = parse_mesh(text != source.end() ? text->get<std::string>() : resolve(source, pointer), pointer);
  const double unit = source.value("unit_mm", 1000.0) * 1e-3;
  const bool z_up = source.value("up", "y") == "z";
  for (Vec3& vertex : mesh.vertices) vertex = unit * (z_up ? y_up(vertex) : vertex);
  return mesh;
}

}  // namespace toile
