#include "engine/mesh/match_mesh.h"

#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace toile {
namespace {

constexpr double kFarthest = 1e3;     // [m] of a coordinate
constexpr double kSameCorner = 1e-3;  // of the largest flat coordinate, between texture coordinates and the pattern

/// A run's mesh.glb shows the body, too.
TriangleMesh without_body(TriangleMesh mesh) {
  if (mesh.group_names != std::vector<std::string>{"garment", "body"}) return mesh;
  std::vector<Triangle> triangles;
  std::vector<std::array<Vec2, 3>> uv;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangle_group[t] != 0) continue;
    triangles.push_back(mesh.triangles[t]);
    if (!mesh.corner_uv.empty()) uv.push_back(mesh.corner_uv[t]);
  }
  mesh.triangles = std::move(triangles);
  mesh.corner_uv = std::move(uv);
  return mesh;
}

/// Triangles as sets, in an order of their own.
std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

bool same_vertices(const Cloth& cloth, const TriangleMesh& mesh) {
  return mesh.vertices.size() == cloth.x.size() &&
         (mesh.triangles.empty() || sorted(mesh.triangles) == sorted(cloth.triangles));
}

/// Whether texture coordinates are the pattern, up to their unit.
bool same_pattern(const Cloth& cloth, const TriangleMesh& mesh) {
  if (mesh.corner_uv.empty()) return true;
  double products = 0, squares = 0, largest = 0;
  for (std::size_t t = 0; t < cloth.flat.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      products += mesh.corner_uv[t][k].dot(cloth.flat[t][k]);
      squares += mesh.corner_uv[t][k].squaredNorm();
      largest = std::max(largest, cloth.flat[t][k].cwiseAbs().maxCoeff());
    }
  const double unit = squares > 0 ? products / squares : 0;
  for (std::size_t t = 0; t < cloth.flat.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if ((unit * mesh.corner_uv[t][k] - cloth.flat[t][k]).norm() > kSameCorner * largest) return false;
  return true;
}

/// Every vertex moves to the mean of the places that are given for it; returns how far apart these are [m].
class Meeting {
 public:
  explicit Meeting(std::size_t vertices) : places_(vertices) {}
  void add(int vertex, const Vec3& place) {
    if (vertex >= 0) places_[vertex].push_back(place);
  }
  double move(Positions& x) const {
    double widest = 0;
    for (std::size_t v = 0; v < places_.size(); ++v) {
      if (places_[v].empty()) continue;
      Vec3 sum = Vec3::Zero();
      for (const Vec3& p : places_[v]) {
        sum += p;
        for (const Vec3& q : places_[v]) widest = std::max(widest, (p - q).norm());
      }
      x[v] = sum / static_cast<double>(places_[v].size());
    }
    return widest;
  }

 private:
  std::vector<Positions> places_;
};

std::string counts(std::size_t vertices, std::size_t triangles) {
  return std::to_string(vertices) + " vertices and " + std::to_string(triangles) + " triangles";
}

}  // namespace

MatchedCloth match_mesh(const Cloth& apart, const TriangleMesh& given) {
  const TriangleMesh mesh = without_body(given);
  for (const Vec3& p : mesh.vertices)
    if (!(p.cwiseAbs().maxCoeff() < kFarthest))
      throw InputError("", "mesh_out_of_range", "a vertex of the mesh is more than a kilometre from the origin");
  MatchedCloth matched{apart, 0};
  const std::vector<int> sewn_vertex = merge_seams(matched.cloth);
  if (same_vertices(matched.cloth, mesh)) {
    matched.cloth.x = mesh.vertices;
    return matched;
  }
  Meeting meeting(matched.cloth.x.size());
  if (same_vertices(apart, mesh)) {
    for (std::size_t v = 0; v < sewn_vertex.size(); ++v) meeting.add(sewn_vertex[v], mesh.vertices[v]);
  } else if (mesh.triangles.size() == matched.cloth.triangles.size() && same_pattern(matched.cloth, mesh)) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) meeting.add(matched.cloth.triangles[t][k], mesh.vertices[mesh.triangles[t][k]]);
  } else {
    throw InputError("", "mesh_mismatch",
                     "The mesh has " + counts(mesh.vertices.size(), mesh.triangles.size()) +
                         "; the scene's garments have " + counts(apart.x.size(), apart.triangles.size()) +
                         " before sewing and " + counts(matched.cloth.x.size(), matched.cloth.triangles.size()) +
                         " after it, and neither vertices nor triangles correspond.");
  }
  matched.seam_gap_max = meeting.move(matched.cloth.x);
  return matched;
}

}  // namespace toile
