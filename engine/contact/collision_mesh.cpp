#include "engine/contact/collision_mesh.h"

#include "engine/mesh/sewing.h"

#include <algorithm>
#include <set>

namespace toile {
namespace {

double smallest_altitude(const std::array<Vec2, 3>& flat) {
  const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0], c = flat[2] - flat[1];
  const double longest = std::max({a.norm(), b.norm(), c.norm()});
  return longest > 0 ? std::abs(a.x() * b.y() - a.y() * b.x()) / longest : 0;
}

/// The numbers of the zones of one kind that each vertex lies in.
std::vector<std::set<int>> zones_of_vertices(const Cloth& cloth, const SeamZone& wanted, const CollisionMesh& mesh) {
  std::vector<std::set<int>> zone(cloth.x.size());
  for (const SeamPair& pair : cloth.seam_pairs)
    if ((cloth.x[pair.a] - cloth.x[pair.b]).norm() > wanted.gap)
      for (int v : {pair.a, pair.b}) zone[v].insert(wanted.same_panel ? -2 - mesh.identity[v] : mesh.identity[v]);
  for (int round = 0; round < wanted.edges; ++round) {
    const std::vector<std::set<int>> before = zone;
    for (const auto& [a, b] : mesh.edges) {
      zone[a].insert(before[b].begin(), before[b].end());
      zone[b].insert(before[a].begin(), before[a].end());
    }
  }
  return zone;
}

}  // namespace

double default_contact_distance(double thickness, double edge_length) {
  return std::max(thickness, std::min(0.18 * edge_length, 3e-3));
}

double default_body_offset(double thickness, double edge_length) {
  return std::max(0.5 * thickness, std::min(0.1 * edge_length, 1.5e-3));
}

double largest_body_offset(const Cloth& cloth, double given) {
  if (given > 0) return given;
  double offset = 0;
  for (const ClothPanel& panel : cloth.panels)
    offset = std::max(offset, default_body_offset(cloth.fabrics[panel.fabric].thickness, panel.edge_length));
  return offset;
}

double CollisionMesh::pair_distance(std::span<const int> a, std::span<const int> b) const {
  double limit = distance_limit[a[0]], wanted_a = wanted_distance[a[0]], wanted_b = wanted_distance[b[0]];
  for (int v : a) limit = std::min(limit, distance_limit[v]), wanted_a = std::min(wanted_a, wanted_distance[v]);
  for (int v : b) limit = std::min(limit, distance_limit[v]), wanted_b = std::min(wanted_b, wanted_distance[v]);
  return std::min(limit, 0.5 * (wanted_a + wanted_b));
}

double CollisionMesh::pair_friction(std::span<const int> a, std::span<const int> b) const {
  double sum = 0;
  for (int v : a)
    for (int w : b) sum += friction.between(fabric[v], fabric[w]);
  return sum / static_cast<double>(a.size() * b.size());
}

CollisionMesh make_collision_mesh(const Cloth& cloth, double contact_distance, const std::vector<SeamZone>& zones) {
  CollisionMesh mesh;
  mesh.triangles = cloth.triangles;
  mesh.identity = seam_representatives(cloth);
  const std::size_t n = cloth.x.size();
  mesh.wanted_distance.assign(n, 1.0);
  mesh.distance_limit.assign(n, 1.0);
  mesh.body_offset.assign(n, 0.0);
  mesh.fabric.assign(n, 0);
  std::vector<char> used(n, 0);
  mesh.friction = friction_table(cloth.fabrics, -1, {});
  std::set<std::array<int, 2>> edges;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const ClothPanel& panel = cloth.panels[cloth.triangle_panel[t]];
    const Fabric& fabric = cloth.fabrics[panel.fabric];
    const double wanted =
        contact_distance > 0 ? contact_distance : default_contact_distance(fabric.thickness, panel.edge_length);
    const double limit = 0.3 * smallest_altitude(cloth.flat[t]);
    const double offset = default_body_offset(fabric.thickness, panel.edge_length);
    for (int k = 0; k < 3; ++k) {
      const int v = cloth.triangles[t][k], w = cloth.triangles[t][(k + 1) % 3];
      mesh.wanted_distance[v] = std::min(mesh.wanted_distance[v], wanted);
      mesh.distance_limit[v] = std::min(mesh.distance_limit[v], limit);
      mesh.body_offset[v] = std::max(mesh.body_offset[v], offset);
      if (!used[v] || fabric.friction_cloth > cloth.fabrics[mesh.fabric[v]].friction_cloth)
        mesh.fabric[v] = panel.fabric;
      used[v] = 1;
      edges.insert({std::min(v, w), std::max(v, w)});
    }
  }
  mesh.edges.assign(edges.begin(), edges.end());
  if (zones.empty()) return mesh;
  mesh.panel.assign(n, 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int v : cloth.triangles[t]) mesh.panel[v] = cloth.triangle_panel[t];
  mesh.seam_zone.assign(n, {});
  for (const SeamZone& wanted : zones) {
    const std::vector<std::set<int>> zone = zones_of_vertices(cloth, wanted, mesh);
    for (std::size_t v = 0; v < n; ++v)
      mesh.seam_zone[v].insert(mesh.seam_zone[v].end(), zone[v].begin(), zone[v].end());
  }
  for (std::vector<int>& zone : mesh.seam_zone) std::sort(zone.begin(), zone.end());
  return mesh;
}

}  // namespace toile
