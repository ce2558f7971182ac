#include "engine/mesh/gltf.h"

#include "engine/mesh/obj.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>  // tinygltf 2.7 needs it even with TINYGLTF_NO_FS
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

// The one translation unit of tinygltf: no images, no files.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

namespace toile {
namespace {

constexpr int kDeepestJson = 64;  // tinygltf walks `extras` recursively
constexpr int kDeepestNodes = 64;
constexpr std::size_t kHeaderSize = 20;  // file header and the JSON chunk's

tinygltf::FsCallbacks no_files() {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string&, void*) { return false; };
  callbacks.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string* error, const std::string&, void*) {
    if (error) *error += "files beside the GLB are not read";
    return false;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  return callbacks;
}

class GlbReader {
 public:
  explicit GlbReader(const std::string& pointer) : pointer_(pointer) {}

  TriangleMesh read(std::string_view bytes) {
    load(bytes);
    std::vector<int> roots;
    if (!model_.scenes.empty()) {
      const int scene = std::max(0, model_.defaultScene);
      roots = at(model_.scenes, scene, "scene").nodes;
    } else {
      std::set<int> children;
      for (const auto& node : model_.nodes) children.insert(node.children.begin(), node.children.end());
      for (int n = 0; n < static_cast<int>(model_.nodes.size()); ++n) {
        if (!children.count(n)) roots.push_back(n);
      }
    }
    for (const int root : roots) read_node(root, Eigen::Affine3d::Identity(), 0);
    if (mesh_.triangles.empty()) fail("it holds no triangles");
    if (!every_primitive_has_uv_) mesh_.corner_uv.clear();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(pointer_, "bad_mesh_file", "the GLB can't be read: " + what);
  }

  template <class T>
  const T& at(const std::vector<T>& list, int index, const char* what) const {
    if (index < 0 || index >= static_cast<int>(list.size()))
      fail(std::string("it names a ") + what + " that is not there");
    return list[static_cast<std::size_t>(index)];
  }

  void load(std::string_view bytes) {
    if (bytes.size() < kHeaderSize || bytes.substr(0, 4) != "glTF") fail("it does not begin as a GLB");
    if (bytes.size() > std::numeric_limits<unsigned int>::max()) fail("it is too large");
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, bytes.data() + 12, sizeof json_size);
    if (json_size > bytes.size() - kHeaderSize) fail("its JSON chunk is cut off");
    check_depth(bytes.substr(kHeaderSize, json_size));
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(no_files());
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                             int, void*) { return true; },
                          nullptr);
    std::string error, warning;
    bool loaded = false;
    try {
      loaded =
          loader.LoadBinaryFromMemory(&model_, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                      static_cast<unsigned int>(bytes.size()));
    } catch (const std::exception& exception) {
      fail(exception.what());
    }
    if (!loaded) fail(error.empty() ? "it is malformed" : error.substr(0, error.find('\n')));
  }

  void check_depth(std::string_view json) const {
    int depth = 0;
    bool text = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const char c = json[i];
      if (text) {
        if (c == '\\') ++i;
        if (c == '"') text = false;
      } else if (c == '"') {
        text = true;
      } else if (c == '[' || c == '{') {
        if (++depth > kDeepestJson) fail("its JSON is nested too deeply");
      } else if (c == ']' || c == '}') {
        --depth;
      }
    }
  }

  static Eigen::Affine3d transform_of(const tinygltf::Node& node) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
          transform.matrix()(row, column) = node.matrix[static_cast<std::size_t>(4 * column + row)];
        }
      }
      return transform;
    }
    if (node.translation.size() == 3) transform.translate(Vec3(node.translation.data()));
    if (node.rotation.size() == 4) {
      transform.rotate(
          Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]).normalized());
    }
    if (node.scale.size() == 3) transform.scale(Vec3(node.scale.data()));
    return transform;
  }

  void read_node(int index, const Eigen::Affine3d& parent, int depth) {
    if (depth > kDeepestNodes || ++visited_ > 100'000) fail("its nodes are nested too deeply");
    const tinygltf::Node& node = at(model_.nodes, index, "node");
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (node.mesh >= 0) read_mesh(at(model_.meshes, node.mesh, "mesh"), node, transform);
    for (const int child : node.children) read_node(child, transform, depth + 1);
  }

  void read_mesh(const tinygltf::Mesh& mesh, const tinygltf::Node& node, const Eigen::Affine3d& transform) {
    std::map<std::tuple<float, float, float>, int> united;
    const int group = static_cast<int>(mesh_.group_names.size());
    mesh_.group_names.push_back(!mesh.name.empty() ? mesh.name : node.name);
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1) continue;
      const auto position = primitive.attributes.find("POSITION");
      if (position == primitive.attributes.end()) fail("a primitive has no positions");
      const std::vector<std::array<float, 3>> points = floats<3>(position->second);
      std::vector<int> vertex;
      for (const auto& p : points) {
        const auto [entry, added] = united.try_emplace({p[0], p[1], p[2]}, static_cast<int>(mesh_.vertices.size()));
        vertex.push_back(entry->second);
        if (!added) continue;
        const Vec3 placed = transform * Vec3(p[0], p[1], p[2]);
        if (!placed.allFinite()) fail("a position is not finite");
        mesh_.vertices.push_back(placed);
        if (mesh_.vertices.size() > kMaxMeshVertices) fail("it has more than two million vertices");
      }
      std::vector<std::array<float, 2>> uvs;
      const auto uv = primitive.attributes.find("TEXCOORD_0");
      if (uv != primitive.attributes.end()) uvs = floats<2>(uv->second);
      const bool has_uv = uvs.size() == points.size();
      every_primitive_has_uv_ = every_primitive_has_uv_ && has_uv;
      const std::vector<std::uint32_t> corners = corners_of(primitive, points.size());
      for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
        Triangle triangle{};
        std::array<Vec2, 3> flat;
        for (std::size_t i = 0; i < 3; ++i) {
          if (corners[c + i] >= points.size()) fail("an index is out of range");
          triangle[i] = vertex[corners[c + i]];
          if (has_uv) flat[i] = Vec2(uvs[corners[c + i]][0], 1.0 - uvs[corners[c + i]][1]);
        }
        // Exporters leave slivers whose corners coincide; they are no surface.
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
        if (has_uv && !(flat[0] + flat[1] + flat[2]).allFinite()) fail("a texture coordinate is not finite");
        if (mesh_.triangles.size() >= kMaxMeshTriangles) fail("it has more than four million triangles");
        mesh_.triangles.push_back(triangle);
        mesh_.triangle_group.push_back(group);
        if (every_primitive_has_uv_) mesh_.corner_uv.push_back(flat);
      }
    }
  }

  std::vector<std::uint32_t> corners_of(const tinygltf::Primitive& primitive, std::size_t points) const {
    std::vector<std::uint32_t> corners;
    if (primitive.indices < 0) {
      for (std::size_t i = 0; i < points; ++i) corners.push_back(static_cast<std::uint32_t>(i));
      return corners;
    }
    const tinygltf::Accessor& accessor = at(model_.accessors, primitive.indices, "accessor");
    std::size_t size = 0;
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) size = 1;
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) size = 2;
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) size = 4;
    if (size == 0 || accessor.type != TINYGLTF_TYPE_SCALAR) fail("its indices are of no kind that the format allows");
    const auto [data, stride] = elements(accessor, size);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      std::uint32_t value = 0;
      std::memcpy(&value, data + i * stride, size);  // little-endian, as glTF and every machine we build for
      corners.push_back(value);
    }
    return corners;
  }

  template <std::size_t N>
  std::vector<std::array<float, N>> floats(int index) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, index, "accessor");
    const int type = N == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC2;
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != type) {
      if (N == 2) return {};  // packed UVs are no flat pattern
      fail("its positions are not three floats");
    }
    const auto [data, stride] = elements(accessor, N * sizeof(float));
    std::vector<std::array<float, N>> values(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i)
      std::memcpy(values[i].data(), data + i * stride, N * sizeof(float));
    return values;
  }

  /// First byte and stride of an accessor whose every element lies inside its buffer.
  std::pair<const unsigned char*, std::size_t> elements(const tinygltf::Accessor& accessor, std::size_t size) const {
    if (accessor.sparse.isSparse) fail("sparse accessors are not read");
    const tinygltf::BufferView& view = at(model_.bufferViews, accessor.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer, "buffer");
    const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
    const std::size_t total = buffer.data.size();
    const bool inside = view.byteOffset <= total && view.byteLength <= total - view.byteOffset &&
                        accessor.byteOffset <= view.byteLength && stride >= size && stride <= 4096;
    const std::size_t room = inside ? view.byteLength - accessor.byteOffset : 0;
    if (!inside || (accessor.count > 0 && (room < size || accessor.count - 1 > (room - size) / stride))) {
      fail("an accessor reaches beyond its buffer");
    }
    return {buffer.data.data() + view.byteOffset + accessor.byteOffset, stride};
  }

  const std::string& pointer_;
  tinygltf::Model model_;
  TriangleMesh mesh_;
  bool every_primitive_has_uv_ = true;
  long visited_ = 0;
};

Positions smooth_normals(const TriangleMesh& mesh) {
  Positions normals(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 area =
        (mesh.vertices[static_cast<std::size_t>(t[1])] - a).cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a);
    for (const int v : t) normals[static_cast<std::size_t>(v)] += area;
  }
  for (Vec3& normal : normals) normal = normal.norm() > 1e-30 ? normal.normalized() : Vec3(Vec3::UnitY());
  return normals;
}

class GlbWriter {
 public:
  GlbWriter() {
    model_.asset.version = "2.0";
    model_.asset.generator = "toile";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
  }

  void add(const TriangleMesh& mesh, const std::string& name, const std::vector<double>& color) {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    const Positions normal = smooth_normals(mesh);
    std::map<std::tuple<int, double, double>, std::uint32_t> written;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int v = mesh.triangles[t][i];
        const Vec2 uv = mesh.corner_uv.empty() ? Vec2(0, 0) : mesh.corner_uv[t][i];
        const auto [entry, added] =
            written.try_emplace({v, uv.x(), uv.y()}, static_cast<std::uint32_t>(positions.size() / 3));
        indices.push_back(entry->second);
        if (!added) continue;
        for (int axis = 0; axis < 3; ++axis) {
          positions.push_back(static_cast<float>(mesh.vertices[static_cast<std::size_t>(v)][axis]));
          normals.push_back(static_cast<float>(normal[static_cast<std::size_t>(v)][axis]));
        }
        uvs.push_back(static_cast<float>(uv.x()));
        uvs.push_back(static_cast<float>(1.0 - uv.y()));  // glTF's v points down
      }
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = accessor(positions, TINYGLTF_TYPE_VEC3, 3);
    set_bounds(model_.accessors.back(), positions);
    primitive.attributes["NORMAL"] = accessor(normals, TINYGLTF_TYPE_VEC3, 3);
    if (!mesh.corner_uv.empty()) primitive.attributes["TEXCOORD_0"] = accessor(uvs, TINYGLTF_TYPE_VEC2, 2);
    primitive.indices = accessor(indices, TINYGLTF_TYPE_SCALAR, 1);
    primitive.material = static_cast<int>(model_.materials.size());
    tinygltf::Material material;
    material.name = name;
    material.doubleSided = true;
    material.pbrMetallicRoughness.baseColorFactor = color;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.9;
    model_.materials.push_back(material);
    tinygltf::Mesh gltf_mesh;
    gltf_mesh.name = name;
    gltf_mesh.primitives.push_back(primitive);
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model_.meshes.size());
    model_.meshes.push_back(gltf_mesh);
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(node);
  }

  std::string bytes() {
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    writer.SetFsCallbacks(no_files());
    if (!writer.WriteGltfSceneToStream(&model_, stream, false, true)) throw std::runtime_error("GLB can't be written");
    return stream.str();
  }

 private:
  template <class T>
  int accessor(const std::vector<T>& values, int type, std::size_t components) {
    std::vector<unsigned char>& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = components == 1 ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
    const auto* raw = reinterpret_cast<const unsigned char*>(values.data());
    data.insert(data.end(), raw, raw + view.byteLength);
    tinygltf::Accessor result;
    result.bufferView = static_cast<int>(model_.bufferViews.size());
    result.componentType =
        std::is_same_v<T, float> ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    result.type = type;
    result.count = values.size() / components;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(result);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  static void set_bounds(tinygltf::Accessor& accessor, const std::vector<float>& positions) {
    accessor.minValues.assign(3, positions.empty() ? 0.0 : std::numeric_limits<double>::infinity());
    accessor.maxValues.assign(3, positions.empty() ? 0.0 : -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      accessor.minValues[i % 3] = std::min(accessor.minValues[i % 3], static_cast<double>(positions[i]));
      accessor.maxValues[i % 3] = std::max(accessor.maxValues[i % 3], static_cast<double>(positions[i]));
    }
  }

  tinygltf::Model model_;
};

}  // namespace

TriangleMesh read_glb(std::string_view bytes, const std::string& pointer) { return GlbReader(pointer).read(bytes); }

std::string write_glb(const TriangleMesh& garment, const TriangleMesh* body) {
  GlbWriter writer;
  writer.add(garment, "garment", {0.55, 0.62, 0.78, 1.0});
  if (body && !body->triangles.empty()) writer.add(*body, "body", {0.7, 0.7, 0.7, 1.0});
  return writer.bytes();
}

}  // namespace toile
