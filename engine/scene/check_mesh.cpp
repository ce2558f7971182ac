#include "engine/geometry/flat_triangle.h"
#include "engine/mesh/topology.h"
#include "engine/scene/check_parts.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

constexpr double kSmallestExtent = 1e-6;  // [m]

}  // namespace

void check_garment_mesh(const GarmentMesh& shape, const std::string& pointer, std::vector<Problem>& problems) {
  const TriangleMesh& mesh = shape.mesh;
  const auto report = [&](const char* code, std::string detail) {
    problems.push_back({pointer, code, std::move(detail)});
  };
  if (mesh.triangles.empty()) return report("empty_garment", "The garment's mesh has no triangles.");
  Vec3 low = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  if ((high - low).maxCoeff() < kSmallestExtent)
    report("collapsed_mesh", "The garment's vertices are all in one place.");
  if (!std::isfinite(shape.uv_unit) || shape.uv_unit <= 0)
    report("not_finite", "The unit of the UVs must be positive.");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (is_place(mesh.vertices[v])) continue;
    return report("not_finite", "Vertex " + std::to_string(v) + " is not finite, or beyond 10 km.");
  }
  const int count = static_cast<int>(mesh.vertices.size());
  const auto outside = [&](int v) { return v < 0 || v >= count; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    if (std::any_of(v.begin(), v.end(), outside)) {
      return report("vertex_out_of_range", "Triangle " + std::to_string(t) + " names a vertex that is not there.");
    }
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      return report("zero_area_triangle", "Triangle " + std::to_string(t) + " names a vertex twice.");
    }
  }
  for (const auto& [a, b] : shape.seams) {
    if (outside(a) || outside(b)) return report("vertex_out_of_range", "A seam names a vertex that is not there.");
    if (a == b) return report("seam_joins_itself", "A seam joins vertex " + std::to_string(a) + " to itself.");
  }
  for (const TriangleMesh::Stitch& s : mesh.stitches) {
    if (outside(s.vertex) || outside(s.from) || outside(s.to) || !(s.t >= 0 && s.t <= 1)) {
      return report("vertex_out_of_range", "A stitch names a vertex that is not there, or a place beyond its edge.");
    }
  }
  if (mesh.corner_uv.size() != mesh.triangles.size()) {
    return report("missing_uv", "A garment mesh needs texture coordinates: they are its flat pattern.");
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = flat_area(mesh.corner_uv[t]) * shape.uv_unit * shape.uv_unit;
    if (std::isfinite(area) && area > 1e-14) continue;
    return report("zero_area_triangle", "Triangle " + std::to_string(t) + " has no area in the flat pattern (UV).");
  }
  const std::vector<MeshEdge> crowded = non_manifold_edges(mesh.triangles);
  if (!crowded.empty()) {
    report("non_manifold_mesh", "The edge between vertices " + std::to_string(crowded[0].v0) + " and " +
                                    std::to_string(crowded[0].v1) + " has " +
                                    std::to_string(crowded[0].triangle_count) + " triangles; " +
                                    std::to_string(crowded.size()) + " edges have more than two.");
  }
}

}  // namespace toile
