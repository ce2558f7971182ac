#include "engine/mesh/topology.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace toile {
namespace {

int opposite(const Triangle& triangle, int a, int b) {
  for (const int v : triangle) {
    if (v != a && v != b) return v;
  }
  return -1;
}

bool runs(const Triangle& t, int from, int to) {
  return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) || (t[2] == from && t[0] == to);
}

}  // namespace

std::vector<MeshEdge> mesh_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 3>> sides;  // v0, v1, triangle
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<MeshEdge> edges;
  for (const auto& [v0, v1, t] : sides) {
    if (edges.empty() || edges.back().v0 != v0 || edges.back().v1 != v1) {
      edges.push_back({v0, v1, t, -1, 1});
      continue;
    }
    MeshEdge& edge = edges.back();
    if (edge.triangle_b < 0) edge.triangle_b = t;
    ++edge.triangle_count;
  }
  return edges;
}

std::vector<Hinge> hinges(const std::vector<Triangle>& triangles) {
  std::vector<Hinge> result;
  for (const MeshEdge& edge : mesh_edges(triangles)) {
    if (edge.triangle_count != 2) continue;
    const Triangle& a = triangles[static_cast<std::size_t>(edge.triangle_a)];
    const Triangle& b = triangles[static_cast<std::size_t>(edge.triangle_b)];
    int v0 = edge.v0, v1 = edge.v1;
    if (!runs(a, v0, v1)) std::swap(v0, v1);
    result.push_back({v0, v1, opposite(a, v0, v1), opposite(b, v0, v1), edge.triangle_a, edge.triangle_b});
  }
  return result;
}

VertexTriangles vertex_triangles(const std::vector<Triangle>& triangles, int vertex_count) {
  VertexTriangles around;
  around.first.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Triangle& triangle : triangles) {
    for (const int v : triangle) ++around.first[static_cast<std::size_t>(v) + 1];
  }
  std::partial_sum(around.first.begin(), around.first.end(), around.first.begin());
  std::vector<int> next(around.first.begin(), around.first.end() - 1);
  around.triangles.resize(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) {
      around.triangles[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
    }
  }
  return around;
}

std::vector<std::vector<int>> boundary_loops(const std::vector<Triangle>& triangles) {
  std::map<int, std::set<int>> open;  // undirected: winding may change along a boundary
  for (const MeshEdge& edge : mesh_edges(triangles)) {
    if (edge.triangle_count != 1) continue;
    open[edge.v0].insert(edge.v1);
    open[edge.v1].insert(edge.v0);
  }
  std::vector<std::vector<int>> loops;
  while (!open.empty()) {
    std::vector<int> loop;
    const int start = open.begin()->first;
    int v = start;
    do {
      loop.push_back(v);
      const auto from = open.find(v);
      if (from == open.end()) break;  // beside an edge of three triangles a boundary may just end
      const int next = *from->second.begin();
      from->second.erase(next);
      if (from->second.empty()) open.erase(from);
      const auto to = open.find(next);
      to->second.erase(v);
      if (to->second.empty()) open.erase(to);
      v = next;
    } while (v != start);
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<MeshEdge> non_manifold_edges(const std::vector<Triangle>& triangles) {
  std::vector<MeshEdge> edges = mesh_edges(triangles);
  std::erase_if(edges, [](const MeshEdge& edge) { return edge.triangle_count <= 2; });
  return edges;
}

std::vector<int> connected_components(const std::vector<Triangle>& triangles) {
  std::vector<int> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int t) {
    while (parent[static_cast<std::size_t>(t)] != t) {
      int& up = parent[static_cast<std::size_t>(t)];
      up = parent[static_cast<std::size_t>(up)];
      t = up;
    }
    return t;
  };
  std::vector<std::array<int, 3>> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t s = 1; s < sides.size(); ++s) {
    if (sides[s][0] != sides[s - 1][0] || sides[s][1] != sides[s - 1][1]) continue;
    const int a = root(sides[s][2]), b = root(sides[s - 1][2]);
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> component(triangles.size()), number(triangles.size(), -1);
  int count = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto r = static_cast<std::size_t>(root(static_cast<int>(t)));
    if (number[r] < 0) number[r] = count++;
    component[t] = number[r];
  }
  return component;
}

long euler_characteristic(const std::vector<Triangle>& triangles) {
  std::set<int> used;
  for (const Triangle& triangle : triangles) used.insert(triangle.begin(), triangle.end());
  return static_cast<long>(used.size()) - static_cast<long>(mesh_edges(triangles).size()) +
         static_cast<long>(triangles.size());
}

}  // namespace toile
