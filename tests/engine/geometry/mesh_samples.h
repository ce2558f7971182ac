#pragma once
// For tests: simple shapes, the real bodies where ../shared is there, and a given number of threads.

#include "engine/geometry/body_field.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/types.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

namespace toile::samples {

/// Only positions and faces (fans of them); enough for the bodies.
inline std::optional<TriangleMesh> read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  TriangleMesh mesh;
  std::string line, word;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    words >> word;
    if (word == "v") {
      Vec3 x;
      words >> x.x() >> x.y() >> x.z();
      mesh.vertices.push_back(x);
    } else if (word == "f") {
      std::vector<int> face;
      while (words >> word) face.push_back(std::stoi(word) - 1);
      for (size_t k = 2; k < face.size(); ++k) mesh.triangles.push_back({face[0], face[k - 1], face[k]});
    }
    word.clear();
  }
  return mesh;
}

inline TriangleMesh icosphere(int subdivisions, double radius, const Vec3& center = Vec3::Zero()) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return at->second;
    };
    std::vector<Triangle> finer;
    for (Vec3& x : mesh.vertices) x.normalize();
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& x : mesh.vertices) x = center + radius * x.normalized();
  return mesh;
}

inline TriangleMesh box_mesh(const Vec3& center, const Vec3& half) {
  return make_body_field(Body{BoxBody{center, half, Mat3::Identity()}, 0.3}, 0.01).surface();
}

inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const int offset = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [x, y, z] : b.triangles) a.triangles.push_back({x + offset, y + offset, z + offset});
  return a;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// What `make` returns when it may use so many threads, also more than the machine has cores.
template <typename Make>
auto on_threads(int threads, Make&& make) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(make);
}

/// z up to y up.
inline TriangleMesh y_up(TriangleMesh mesh) {
  for (Vec3& x : mesh.vertices) x = {x.x(), x.z(), -x.y()};
  return mesh;
}

}  // namespace toile::samples
