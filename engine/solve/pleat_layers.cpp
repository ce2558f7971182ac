#include "engine/solve/pleat_layers.h"

#include "engine/geometry/bvh.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile {
namespace {

constexpr int kSweeps = 400;       // at most
constexpr double kInOrder = 0.05;  // of the spacing wanted: enough

/// A point of the panel.
struct Place {
  Triangle vertices;
  Vec3 weights;
};

/// Two places that overlap, the upper one first, and how far it is to lie above the other [m].
struct Overlap {
  Place upper, lower;
  double spacing;
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

class Overlaps {
 public:
  Overlaps(const FoldedPanel& panel, const LayerAt& layer, double spacing)
      : panel_(panel), layer_(layer), spacing_(spacing) {}

  std::vector<Overlap> find() {
    const std::vector<Triangle> triangles = kept_triangles(panel_);
    std::vector<std::array<int, 2>> edges;
    std::vector<int> vertices;
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) {
        vertices.push_back(t[k]);
        const int next = t[(k + 1) % 3];
        edges.push_back({std::min(t[k], next), std::max(t[k], next)});
      }
    const auto unique = [](auto& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    unique(edges);
    unique(vertices);
    vertices_over_triangles(vertices, triangles);
    edges_over_edges(edges);
    return std::move(found_);
  }

 private:
  Vec2 at(int v) const { return panel_.plane[panel_.joined[v]]; }
  Box box_of(std::initializer_list<int> vertices) const {
    Box box;
    for (int v : vertices) box.extend(Vec3(at(v).x(), at(v).y(), 0));
    return box;
  }
  bool joined(int a, int b) const { return panel_.joined[a] == panel_.joined[b]; }

  void add(const Place& a, const Place& b) {
    const double difference = layer_(b.vertices, b.weights) - layer_(a.vertices, a.weights);
    if (difference > 0) found_.push_back({a, b, spacing_ * difference});
    if (difference < 0) found_.push_back({b, a, -spacing_ * difference});
  }

  void vertices_over_triangles(const std::vector<int>& vertices, const std::vector<Triangle>& triangles) {
    std::vector<Box> boxes;
    for (const Triangle& t : triangles) boxes.push_back(box_of({t[0], t[1], t[2]}));
    const Bvh tree(boxes);
    for (int v : vertices)
      tree.query(box_of({v}), [&](int i) {
        const Triangle& t = triangles[i];
        if (joined(v, t[0]) || joined(v, t[1]) || joined(v, t[2])) return;
        const Vec2 a = at(t[0]) - at(v), b = at(t[1]) - at(v), c = at(t[2]) - at(v);
        const Vec3 areas(cross(b, c), cross(c, a), cross(a, b));
        if (areas.minCoeff() < 0 && areas.maxCoeff() > 0) return;
        const double area = areas.sum();
        if (area != 0) add({{v, v, v}, Vec3(1, 0, 0)}, {t, areas / area});
      });
  }

  void edges_over_edges(const std::vector<std::array<int, 2>>& edges) {
    std::vector<Box> boxes;
    for (const auto& [a, b] : edges) boxes.push_back(box_of({a, b}));
    const Bvh tree(boxes);
    for (std::size_t i = 0; i < edges.size(); ++i)
      tree.query(boxes[i], [&](int j) {
        if (j <= static_cast<int>(i)) return;
        const auto& [a, b] = edges[i];
        const auto& [c, d] = edges[j];
        if (joined(a, c) || joined(a, d) || joined(b, c) || joined(b, d)) return;
        const Vec2 p = at(b) - at(a), q = at(d) - at(c), r = at(c) - at(a);
        const double turn = cross(p, q);
        if (turn == 0) return;
        const double s = cross(r, q) / turn, t = cross(r, p) / turn;
        if (s < 0 || s > 1 || t < 0 || t > 1) return;
        add({{a, b, b}, Vec3(1 - s, s, 0)}, {{c, d, d}, Vec3(1 - t, t, 0)});
      });
  }

  const FoldedPanel& panel_;
  const LayerAt& layer_;
  double spacing_;
  std::vector<Overlap> found_;
};

}  // namespace

std::vector<Triangle> kept_triangles(const FoldedPanel& panel) {
  std::map<Triangle, int> times;
  const auto key = [&](const Triangle& t) {
    Triangle k{panel.joined[t[0]], panel.joined[t[1]], panel.joined[t[2]]};
    std::sort(k.begin(), k.end());
    return k;
  };
  for (const Triangle& t : panel.triangles) ++times[key(t)];
  std::vector<Triangle> kept;
  for (const Triangle& t : panel.triangles) {
    const Triangle k = key(t);
    if (k[0] != k[1] && k[1] != k[2] && times[k] == 1) kept.push_back(t);
  }
  return kept;
}

void lay_in_order(FoldedPanel& panel, const LayerAt& layer, double spacing) {
  const std::vector<Overlap> overlaps = Overlaps(panel, layer, spacing).find();
  const auto height = [&](const Place& place) {
    double h = 0;
    for (int k = 0; k < 3; ++k) h += place.weights[k] * panel.height[panel.joined[place.vertices[k]]];
    return h;
  };
  const auto move = [&](const Place& place, double by) {
    for (int k = 0; k < 3; ++k) panel.height[panel.joined[place.vertices[k]]] += by * place.weights[k];
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool in_order = true;
    for (const Overlap& overlap : overlaps) {
      const double lack = overlap.spacing - (height(overlap.upper) - height(overlap.lower));
      if (lack <= 0) continue;
      in_order = in_order && lack < (1 - kInOrder) * overlap.spacing;
      const double weight = overlap.upper.weights.squaredNorm() + overlap.lower.weights.squaredNorm();
      move(overlap.upper, lack / weight);
      move(overlap.lower, -lack / weight);
    }
    if (in_order) break;
  }
  for (std::size_t v = 0; v < panel.height.size(); ++v) panel.height[v] = panel.height[panel.joined[v]];
}

}  // namespace toile
