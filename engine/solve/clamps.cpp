#include "engine/solve/clamps.h"

#include "engine/mesh/topology.h"

namespace toile {
namespace {

int corner_opposite(const Triangle& triangle, int a, int b) {
  for (int c = 0; c < 3; ++c)
    if (triangle[c] != a && triangle[c] != b) return c;
  return 0;
}

/// From the edge a–b towards p, at a right angle to it.
Vec3 arm(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 e = b - a;
  return (p - a) - (p - a).dot(e) / e.squaredNorm() * e;
}

}  // namespace

std::vector<HeldVertex> add_clamps(Cloth& cloth, const std::vector<HeldVertex>& held) {
  std::vector<const HeldVertex*> clamp(cloth.x.size(), nullptr);
  bool any = false;
  for (const HeldVertex& h : held)
    if (h.clamped) clamp[static_cast<std::size_t>(h.vertex)] = &h, any = true;
  std::vector<HeldVertex> points;
  if (!any) return points;
  const auto clamped = [&](int v) { return clamp[static_cast<std::size_t>(v)] != nullptr; };

  for (const MeshEdge& edge : mesh_edges(cloth.triangles)) {
    if (!clamped(edge.v0) || !clamped(edge.v1)) continue;
    std::vector<std::pair<int, int>> free;  // triangle, corner
    int holding = -1;
    for (const int t : {edge.triangle_a, edge.triangle_b}) {
      if (t < 0) continue;
      const int corner = corner_opposite(cloth.triangles[t], edge.v0, edge.v1), tip = cloth.triangles[t][corner];
      if (clamped(tip))
        holding = tip;
      else
        free.emplace_back(t, corner);
    }
    if (free.empty()) continue;
    if (holding >= 0) {
      cloth.clamps.push_back({free[0].first, free[0].second, holding});
      continue;
    }
    const Vec3 a = cloth.x[edge.v0], b = cloth.x[edge.v1];
    std::vector<Vec3> arms;
    for (const auto& [t, corner] : free) arms.push_back(arm(cloth.x[cloth.triangles[t][corner]], a, b));
    const Vec3 tangent =
        arms.size() == 2 ? Vec3(arms[0].normalized() - arms[1].normalized()).normalized() : arms[0].normalized();
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Vec3 place = 0.5 * (a + b) - (k == 0 ? 1 : -1) * arms[k].norm() * tangent;
      points.push_back(
          {static_cast<int>(cloth.x.size()), place, clamp[static_cast<std::size_t>(edge.v0)]->motion, true});
      cloth.clamps.push_back({free[k].first, free[k].second, points.back().vertex});
      cloth.x.push_back(place);
    }
  }
  return points;
}

}  // namespace toile
