#include "engine/solve/approach.h"

#include "engine/contact/proximity.h"
#include "engine/mesh/sewing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile {
namespace {

constexpr double kNear = 0.03;         // [m] from the body: room for the panel to bend round it
constexpr double kStep = 0.25;         // edges: within the displacement bounds behind the seams' zones
constexpr double kListRadius = 12e-3;  // [m]
constexpr int kSteps = 400;
constexpr double kFlat = 0.95;  // of the sum of a panel's area vectors over its area

/// Unit normals of the panels; zero of one that is not flat.
std::vector<Vec3> panel_normals(const Cloth& apart) {
  std::vector<Vec3> normal(apart.panels.size(), Vec3::Zero());
  std::vector<double> area(apart.panels.size(), 0);
  for (std::size_t t = 0; t < apart.triangles.size(); ++t) {
    const auto& [a, b, c] = apart.triangles[t];
    const Vec3 twice = (apart.x[b] - apart.x[a]).cross(apart.x[c] - apart.x[a]);
    normal[apart.triangle_panel[t]] += twice;
    area[apart.triangle_panel[t]] += twice.norm();
  }
  for (std::size_t p = 0; p < normal.size(); ++p) {
    const double length = normal[p].norm();
    normal[p] = length > kFlat * area[p] ? Vec3(normal[p] / length) : Vec3(Vec3::Zero());
  }
  return normal;
}

double step_length(const Cloth& apart, int garment) {
  double edge = kListRadius;
  for (const ClothPanel& panel : apart.panels)
    if (panel.garment == garment && panel.edge_length > 0) edge = std::min(edge, panel.edge_length);
  return kStep * edge;
}

}  // namespace

void approach(Cloth& apart, int garment, CollisionMesh mesh, const std::vector<const BodyField*>& field,
              const std::vector<char>& held) {
  const std::vector<int> panel_of_vertex = panel_of_vertices(apart);
  std::vector<std::vector<int>> vertices(apart.panels.size());
  std::vector<char> moving(apart.panels.size(), 0);
  const std::vector<Vec3> normal = panel_normals(apart);
  for (std::size_t p = 0; p < moving.size(); ++p)
    moving[p] = apart.panels[p].garment == garment && normal[p] != Vec3::Zero();
  for (std::size_t v = 0; v < panel_of_vertex.size(); ++v) {
    if (panel_of_vertex[v] < 0) continue;
    vertices[panel_of_vertex[v]].push_back(static_cast<int>(v));
    if (held[v]) moving[panel_of_vertex[v]] = 0;
  }
  // Within a panel nothing comes nearer: all of it is one zone.
  mesh.seam_zone.resize(apart.x.size());
  for (std::size_t v = 0; v < apart.x.size(); ++v)
    mesh.seam_zone[v].insert(mesh.seam_zone[v].begin(), -3 - static_cast<int>(apart.x.size()) - panel_of_vertex[v]);
  const double longest = step_length(apart, garment);
  Proximity proximity(std::move(mesh), kListRadius);
  for (int step = 0; step < kSteps && std::find(moving.begin(), moving.end(), 1) != moving.end(); ++step) {
    std::vector<double> wanted(moving.size(), 0);  // along the normal, summed over seams
    std::vector<int> seams(moving.size(), 0);
    const auto pull = [&](int v, int to) {
      const int p = panel_of_vertex[v];
      wanted[p] += normal[p].dot(apart.x[to] - apart.x[v]);
      ++seams[p];
    };
    for (const SeamPair& pair : apart.seam_pairs) {
      const int p = panel_of_vertex[pair.a], q = panel_of_vertex[pair.b];
      if (p == q || p < 0 || q < 0 || apart.panels[p].garment != apart.panels[q].garment) continue;
      pull(pair.a, pair.b);
      pull(pair.b, pair.a);
    }
    proximity.update(apart.x);
    const std::vector<double>& bounds = proximity.displacement_bounds();
    for (std::size_t p = 0; p < moving.size(); ++p) {
      if (!moving[p]) continue;
      const double way = seams[p] > 0 ? std::abs(wanted[p]) / seams[p] : 0;
      const double length = std::min(longest, 0.5 * way);
      const Vec3 move = std::copysign(length, wanted[p]) * normal[p];
      moving[p] = way > longest && std::all_of(vertices[p].begin(), vertices[p].end(), [&](int v) {
                    return bounds[v] >= length && (!field[v] || field[v]->distance(apart.x[v] + move) >= kNear);
                  });
      if (!moving[p]) continue;
      for (int v : vertices[p]) apart.x[v] += move;
    }
  }
}

}  // namespace toile
