#include "engine/mesh/sewing.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace toile {
namespace {

int find_root(std::vector<int>& parent, int vertex) {
  while (parent[static_cast<std::size_t>(vertex)] != vertex) {
    int& up = parent[static_cast<std::size_t>(vertex)];
    up = parent[static_cast<std::size_t>(up)];
    vertex = up;
  }
  return vertex;
}

std::vector<int> representatives(std::size_t vertices, const std::vector<SeamPair>& pairs) {
  std::vector<int> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  for (const SeamPair& pair : pairs) {
    const int a = find_root(parent, pair.a), b = find_root(parent, pair.b);
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (int v = 0; v < static_cast<int>(parent.size()); ++v) parent[static_cast<std::size_t>(v)] = find_root(parent, v);
  return parent;
}

double gap_of(const Cloth& cloth, const SeamPair& pair) {
  return (cloth.x[static_cast<std::size_t>(pair.a)] - cloth.x[static_cast<std::size_t>(pair.b)]).norm();
}

/// Per triangle: its corners became one, or it lies on another with the same three corners, as the two at the tip of a
/// pleat do. Of those an odd one is left.
std::vector<char> flattened(const std::vector<Triangle>& triangles) {
  std::vector<char> flat(triangles.size(), 0);
  std::map<Triangle, std::size_t> single;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle v = triangles[t];
    std::sort(v.begin(), v.end());
    flat[t] = v[0] == v[1] || v[1] == v[2];
    if (flat[t]) continue;
    const auto [at, fresh] = single.try_emplace(v, t);
    if (fresh) continue;
    flat[t] = flat[at->second] = 1;
    single.erase(at);
  }
  return flat;
}

/// Returns the new index of each vertex: -1 for those that only dropped triangles had.
std::vector<int> drop_flattened(Cloth& cloth) {
  const std::vector<char> flat = flattened(cloth.triangles);
  std::vector<int> renumbered(cloth.x.size());
  std::iota(renumbered.begin(), renumbered.end(), 0);
  std::vector<char> lost(cloth.x.size(), 0), used(cloth.x.size(), 0);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    for (const int v : cloth.triangles[t]) (flat[t] ? lost : used)[static_cast<std::size_t>(v)] = 1;
    if (flat[t]) continue;
    cloth.triangles[kept] = cloth.triangles[t];
    cloth.flat[kept] = cloth.flat[t];
    cloth.triangle_panel[kept] = cloth.triangle_panel[t];
    ++kept;
  }
  const std::size_t dropped = cloth.triangles.size() - kept;
  if (dropped == 0) return renumbered;
  cloth.triangles.resize(kept);
  cloth.flat.resize(kept);
  cloth.triangle_panel.resize(kept);
  int next = 0;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    renumbered[v] = lost[v] && !used[v] ? -1 : next++;
    if (renumbered[v] < 0) continue;
    cloth.x[static_cast<std::size_t>(renumbered[v])] = cloth.x[v];
    cloth.vertex_garment[static_cast<std::size_t>(renumbered[v])] = cloth.vertex_garment[v];
  }
  cloth.x.resize(static_cast<std::size_t>(next));
  cloth.vertex_garment.resize(static_cast<std::size_t>(next));
  for (Triangle& triangle : cloth.triangles) {
    for (int& v : triangle) v = renumbered[static_cast<std::size_t>(v)];
  }
  cloth.warnings.push_back(
      "collapsed_triangles: " + std::to_string(dropped) +
      " triangles had corners that a seam makes one, or were laid on each other, and were dropped");
  return renumbered;
}

}  // namespace

std::vector<int> panel_of_vertices(const Cloth& apart) {
  std::vector<int> panel(apart.x.size(), -1);
  for (std::size_t t = 0; t < apart.triangles.size(); ++t) {
    for (const int v : apart.triangles[t]) panel[static_cast<std::size_t>(v)] = apart.triangle_panel[t];
  }
  return panel;
}

std::vector<int> seam_representatives(const Cloth& cloth) { return representatives(cloth.x.size(), cloth.seam_pairs); }

double seam_gap_max(const Cloth& cloth) {
  double gap = 0;
  for (const SeamPair& pair : cloth.seam_pairs) {
    gap = std::max(gap, gap_of(cloth, pair));
  }
  return gap;
}

std::vector<int> merge_closed_seams(Cloth& cloth, double gap) {
  std::vector<SeamPair> closed, open;
  for (const SeamPair& pair : cloth.seam_pairs) (gap_of(cloth, pair) <= gap ? closed : open).push_back(pair);
  const std::vector<int> root = representatives(cloth.x.size(), closed);
  std::vector<int> renumbered(root.size(), -1), members;
  Positions merged;
  std::vector<int> garment;
  for (std::size_t v = 0; v < root.size(); ++v) {
    const auto r = static_cast<std::size_t>(root[v]);
    if (renumbered[r] < 0) {
      renumbered[r] = static_cast<int>(merged.size());
      merged.push_back(Vec3::Zero());
      members.push_back(0);
      garment.push_back(cloth.vertex_garment[v]);
    }
    renumbered[v] = renumbered[r];
    merged[static_cast<std::size_t>(renumbered[v])] += cloth.x[v];
    ++members[static_cast<std::size_t>(renumbered[v])];
  }
  for (std::size_t v = 0; v < merged.size(); ++v) merged[v] /= members[v];
  cloth.x = std::move(merged);
  cloth.vertex_garment = std::move(garment);
  for (Triangle& triangle : cloth.triangles) {
    for (int& vertex : triangle) vertex = renumbered[static_cast<std::size_t>(vertex)];
  }
  const std::vector<int> kept = drop_flattened(cloth);
  for (int& vertex : renumbered) vertex = kept[static_cast<std::size_t>(vertex)];
  for (PlacedVertex& placed : cloth.placed) placed.vertex = renumbered[static_cast<std::size_t>(placed.vertex)];
  std::erase_if(cloth.placed, [](const PlacedVertex& placed) { return placed.vertex < 0; });
  for (LabelledVertices& label : cloth.labels) {
    for (int& vertex : label.vertices) vertex = renumbered[static_cast<std::size_t>(vertex)];
    std::erase(label.vertices, -1);
    label.vertices.erase(std::unique(label.vertices.begin(), label.vertices.end()), label.vertices.end());
  }
  for (Crease& crease : cloth.creases) {
    crease.v0 = renumbered[static_cast<std::size_t>(crease.v0)];
    crease.v1 = renumbered[static_cast<std::size_t>(crease.v1)];
  }
  std::erase_if(cloth.creases, [](const Crease& c) { return c.v0 < 0 || c.v1 < 0 || c.v0 == c.v1; });
  cloth.seam_pairs.clear();
  for (const SeamPair& pair : open) {
    const int a = renumbered[static_cast<std::size_t>(pair.a)], b = renumbered[static_cast<std::size_t>(pair.b)];
    if (a >= 0 && b >= 0 && a != b) cloth.seam_pairs.push_back({a, b, pair.seam});
  }
  return renumbered;
}

std::vector<int> merge_seams(Cloth& cloth) {
  return merge_closed_seams(cloth, std::numeric_limits<double>::infinity());
}

}  // namespace toile
