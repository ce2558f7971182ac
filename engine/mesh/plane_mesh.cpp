#include "engine/mesh/plane_mesh.h"

#include <boost/polygon/voronoi.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace toile {
namespace {

using Int128 = __int128;
using GridPoint = boost::polygon::point_data<int>;

constexpr int kPanelExtent = 1 << 26;  // grid units across a panel
constexpr int kFrameExtent = 1 << 28;  // half the frame around it: keeps all circumcentres of the panel's hull finite
constexpr int kFramePoints = 4;

std::int64_t orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const std::int64_t abx = b.x() - a.x(), aby = b.y() - a.y(), acx = c.x() - a.x(), acy = c.y() - a.y();
  return abx * acy - aby * acx;
}

/// Positive where d lies inside the circle through the counter-clockwise a, b, c.
Int128 in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const std::int64_t ax = a.x() - d.x(), ay = a.y() - d.y(), bx = b.x() - d.x(), by = b.y() - d.y();
  const std::int64_t cx = c.x() - d.x(), cy = c.y() - d.y();
  const auto square = [](std::int64_t x, std::int64_t y) { return static_cast<Int128>(x * x + y * y); };
  return square(ax, ay) * (bx * cy - by * cx) - square(bx, by) * (ax * cy - ay * cx) +
         square(cx, cy) * (ax * by - ay * bx);
}

int corner_of(const Triangle& triangle, int vertex) {
  return static_cast<int>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
}

int side_towards(const std::array<int, 3>& neighbours, int triangle) {
  return static_cast<int>(std::find(neighbours.begin(), neighbours.end(), triangle) - neighbours.begin());
}

std::uint64_t edge_key(int a, int b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint64_t>(std::max(a, b));
}

void link_neighbours(PlaneMesh& mesh) {
  mesh.neighbours.assign(mesh.triangles.size(), {-1, -1, -1});
  mesh.triangle_at.assign(mesh.points.size(), -1);
  std::unordered_map<std::uint64_t, std::pair<int, int>> open;
  open.reserve(mesh.triangles.size() * 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Triangle& v = mesh.triangles[t];
      mesh.triangle_at[static_cast<std::size_t>(v[i])] = static_cast<int>(t);
      const std::uint64_t key = edge_key(v[(i + 1) % 3], v[(i + 2) % 3]);
      const auto [entry, added] = open.try_emplace(key, static_cast<int>(t), static_cast<int>(i));
      if (added) continue;
      const auto [other, side] = entry->second;
      mesh.neighbours[t][i] = other;
      mesh.neighbours[static_cast<std::size_t>(other)][static_cast<std::size_t>(side)] = static_cast<int>(t);
    }
  }
}

/// Points on the grid, framed by four far ones at the end; one attempt of several, each turned by another angle.
class GridTriangulation {
 public:
  GridTriangulation(const std::vector<Vec2>& outline, const std::vector<Vec2>& inner, double turn)
      : outline_size_(static_cast<int>(outline.size())) {
    mesh_.points = outline;
    mesh_.points.insert(mesh_.points.end(), inner.begin(), inner.end());
    Vec2 low = outline.front(), high = outline.front();
    for (const Vec2& p : outline) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double scale = kPanelExtent / (high - low).norm();
    const Eigen::Rotation2Dd rotation(turn);
    for (const Vec2& p : mesh_.points) {
      const Vec2 q = rotation * (p - (low + high) / 2) * scale;
      grid_.emplace_back(static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y())));
    }
    grid_.emplace_back(-kFrameExtent, -kFrameExtent);
    grid_.emplace_back(kFrameExtent, -kFrameExtent);
    grid_.emplace_back(kFrameExtent, kFrameExtent);
    grid_.emplace_back(-kFrameExtent, kFrameExtent);
    mesh_.points.resize(grid_.size(), Vec2::Zero());
  }

  std::optional<PlaneMesh> build() {
    if (!triangulate()) return std::nullopt;
    restore_delaunay();
    for (int i = 0; i < outline_size_; ++i) {
      if (!recover(i, (i + 1) % outline_size_)) return std::nullopt;
    }
    restore_delaunay();
    trim();
    return std::move(mesh_);
  }

 private:
  const GridPoint& at(int vertex) const { return grid_[static_cast<std::size_t>(vertex)]; }
  Triangle& triangle(int t) { return mesh_.triangles[static_cast<std::size_t>(t)]; }
  int neighbour(int t, int i) const {
    return mesh_.neighbours[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
  }
  bool on_outline(int a, int b) const {
    if (a >= outline_size_ || b >= outline_size_) return false;
    return (a + 1) % outline_size_ == b || (b + 1) % outline_size_ == a;
  }

  /// False where the library's diagram is not a triangulation on this grid (points that coincide or merged vertices).
  bool triangulate() {
    std::vector<std::pair<int, int>> sorted;
    for (const GridPoint& p : grid_) sorted.emplace_back(p.x(), p.y());
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;

    boost::polygon::voronoi_diagram<double> diagram;
    boost::polygon::construct_voronoi(grid_.begin(), grid_.end(), &diagram);
    std::vector<int> cells;
    for (const auto& vertex : diagram.vertices()) {
      cells.clear();
      const auto* edge = vertex.incident_edge();
      do {
        cells.push_back(static_cast<int>(edge->cell()->source_index()));
        edge = edge->rot_next();
      } while (edge != vertex.incident_edge());
      // Four and more points on one circle: any fan will do.
      for (std::size_t k = 1; k + 1 < cells.size(); ++k) {
        if (orientation(at(cells[0]), at(cells[k]), at(cells[k + 1])) <= 0) return false;
        mesh_.triangles.push_back({cells[0], cells[k], cells[k + 1]});
      }
    }
    if (mesh_.triangles.size() != 2 * grid_.size() - 2 - kFramePoints) return false;
    link_neighbours(mesh_);
    return true;
  }

  bool flippable(int t, int i) {
    const int u = neighbour(t, i);
    if (u < 0) return false;
    const auto k = static_cast<std::size_t>(i);
    const int a = triangle(t)[k], b = triangle(t)[(k + 1) % 3], c = triangle(t)[(k + 2) % 3];
    const int d = triangle(u)[static_cast<std::size_t>(side_towards(mesh_.neighbours[static_cast<std::size_t>(u)], t))];
    return orientation(at(a), at(b), at(d)) > 0 && orientation(at(a), at(d), at(c)) > 0;
  }

  void restore_delaunay() {
    std::deque<std::pair<int, int>> waiting;
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      for (int i = 0; i < 3; ++i) {
        if (neighbour(t, i) > t) waiting.emplace_back(t, i);
      }
    }
    while (!waiting.empty()) {
      const auto [t, i] = waiting.front();
      waiting.pop_front();
      const int u = neighbour(t, i);
      if (u < 0 || !flippable(t, i)) continue;
      const auto k = static_cast<std::size_t>(i);
      const int b = triangle(t)[(k + 1) % 3], c = triangle(t)[(k + 2) % 3];
      if (on_outline(b, c)) continue;
      const int d =
          triangle(u)[static_cast<std::size_t>(side_towards(mesh_.neighbours[static_cast<std::size_t>(u)], t))];
      if (in_circle(at(triangle(t)[0]), at(triangle(t)[1]), at(triangle(t)[2]), at(d)) <= 0) continue;
      mesh_.flip(t, i);
      for (int side = 0; side < 3; ++side) {
        waiting.emplace_back(t, side);
        waiting.emplace_back(u, side);
      }
    }
  }

  /// The triangle and corner whose opposite edge joins a and b; a must not be a frame point.
  std::optional<std::pair<int, int>> find_edge(int a, int b) {
    const int start = mesh_.triangle_at[static_cast<std::size_t>(a)];
    int t = start;
    do {
      const int i = corner_of(triangle(t), a);
      if (triangle(t)[static_cast<std::size_t>((i + 1) % 3)] == b) return std::pair(t, (i + 2) % 3);
      t = neighbour(t, (i + 1) % 3);
    } while (t != start && t >= 0);
    return std::nullopt;
  }

  /// Makes the segment from a to b an edge by flipping what crosses it.
  bool recover(int a, int b) {
    if (find_edge(a, b)) return true;
    std::deque<std::pair<int, int>> crossing;
    if (!edges_across(a, b, crossing)) return false;
    std::size_t stalled = 0;
    while (!crossing.empty()) {
      auto [p, q] = crossing.front();
      crossing.pop_front();
      if (p >= static_cast<int>(grid_.size()) - kFramePoints) std::swap(p, q);
      const auto edge = find_edge(p, q);
      if (!edge) return false;
      const auto [t, i] = *edge;
      if (!flippable(t, i)) {
        crossing.emplace_back(p, q);
        if (++stalled > 2 * crossing.size() + 8) return false;
        continue;
      }
      stalled = 0;
      const int u = neighbour(t, i);
      const int c = triangle(t)[static_cast<std::size_t>(i)];
      const int d =
          triangle(u)[static_cast<std::size_t>(side_towards(mesh_.neighbours[static_cast<std::size_t>(u)], t))];
      mesh_.flip(t, i);
      if (c == a || c == b || d == a || d == b) continue;
      if ((orientation(at(a), at(b), at(c)) > 0) != (orientation(at(a), at(b), at(d)) > 0)) crossing.emplace_back(c, d);
    }
    return find_edge(a, b).has_value();
  }

  bool edges_across(int a, int b, std::deque<std::pair<int, int>>& crossing) {
    const int start = mesh_.triangle_at[static_cast<std::size_t>(a)];
    int t = start, right = -1, left = -1;
    do {
      const int i = corner_of(triangle(t), a);
      const int p = triangle(t)[static_cast<std::size_t>((i + 1) % 3)];
      const int q = triangle(t)[static_cast<std::size_t>((i + 2) % 3)];
      const auto sp = orientation(at(a), at(b), at(p)), sq = orientation(at(a), at(b), at(q));
      if (sp < 0 && sq > 0) {
        right = p;
        left = q;
        break;
      }
      t = neighbour(t, (i + 1) % 3);
    } while (t != start);
    if (right < 0) return false;  // a point lies on the segment
    while (true) {
      crossing.emplace_back(right, left);
      const int third = 3 - corner_of(triangle(t), right) - corner_of(triangle(t), left);
      t = neighbour(t, third);
      const int ahead =
          triangle(t)[static_cast<std::size_t>(3 - corner_of(triangle(t), right) - corner_of(triangle(t), left))];
      if (ahead == b) return true;
      const auto side = orientation(at(a), at(b), at(ahead));
      if (side == 0) return false;
      (side > 0 ? left : right) = ahead;
    }
  }

  /// Drops what can be reached from the frame without crossing the outline, and the frame itself.
  void trim() {
    std::vector<char> outside(mesh_.triangles.size(), 0);
    std::vector<int> stack = {mesh_.triangle_at[grid_.size() - 1]};
    outside[static_cast<std::size_t>(stack[0])] = 1;
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const int u = neighbour(t, i);
        const auto k = static_cast<std::size_t>(i);
        if (u < 0 || outside[static_cast<std::size_t>(u)] ||
            on_outline(triangle(t)[(k + 1) % 3], triangle(t)[(k + 2) % 3]))
          continue;
        outside[static_cast<std::size_t>(u)] = 1;
        stack.push_back(u);
      }
    }
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!outside[t]) kept.push_back(mesh_.triangles[t]);
    }
    mesh_.triangles = std::move(kept);
    mesh_.points.resize(grid_.size() - kFramePoints);
    link_neighbours(mesh_);
  }

  int outline_size_;
  PlaneMesh mesh_;
  std::vector<GridPoint> grid_;
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

void PlaneMesh::flip(int t, int i) {
  const int u = neighbours[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
  Triangle &tv = triangles[static_cast<std::size_t>(t)], &uv = triangles[static_cast<std::size_t>(u)];
  auto &tn = neighbours[static_cast<std::size_t>(t)], &un = neighbours[static_cast<std::size_t>(u)];
  const auto k = static_cast<std::size_t>(i);
  const auto j = static_cast<std::size_t>(side_towards(un, t));
  const int a = tv[k], b = tv[(k + 1) % 3], c = tv[(k + 2) % 3], d = uv[j];
  const int across_ca = tn[(k + 1) % 3], across_ab = tn[(k + 2) % 3];
  const int across_bd = un[(j + 1) % 3], across_dc = un[(j + 2) % 3];
  tv = {a, b, d};
  tn = {across_bd, u, across_ab};
  uv = {a, d, c};
  un = {across_dc, across_ca, t};
  const auto relink = [&](int neighbour, int from, int to) {
    if (neighbour < 0) return;
    auto& links = neighbours[static_cast<std::size_t>(neighbour)];
    links[static_cast<std::size_t>(side_towards(links, from))] = to;
  };
  relink(across_bd, u, t);
  relink(across_ca, t, u);
  triangle_at[static_cast<std::size_t>(a)] = t;
  triangle_at[static_cast<std::size_t>(b)] = t;
  triangle_at[static_cast<std::size_t>(d)] = t;
  triangle_at[static_cast<std::size_t>(c)] = u;
}

PlaneMesh constrained_delaunay(const std::vector<Vec2>& outline, const std::vector<Vec2>& inner) {
  // Turned grids: what is degenerate in one (a sample that snaps onto another segment) is not in the next.
  for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
    if (auto mesh = GridTriangulation(outline, inner, turn).build()) return std::move(*mesh);
  }
  throw std::runtime_error("the outline touches itself");
}

void flip_to_delaunay(PlaneMesh& mesh) {
  constexpr double kMargin = 1e-9;  // on the sum of two cotangents; flips of a square would go on for ever
  for (int pass = 0; pass < 100; ++pass) {
    bool flipped = false;
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      for (int i = 0; i < 3; ++i) {
        const int u = mesh.neighbours[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
        if (u < 0) continue;
        const Triangle& v = mesh.triangles[static_cast<std::size_t>(t)];
        const auto k = static_cast<std::size_t>(i);
        const auto& back = mesh.neighbours[static_cast<std::size_t>(u)];
        const int opposite =
            mesh.triangles[static_cast<std::size_t>(u)][static_cast<std::size_t>(side_towards(back, t))];
        const Vec2 &a = mesh.points[static_cast<std::size_t>(v[k])],
                   &b = mesh.points[static_cast<std::size_t>(v[(k + 1) % 3])];
        const Vec2 &c = mesh.points[static_cast<std::size_t>(v[(k + 2) % 3])],
                   &d = mesh.points[static_cast<std::size_t>(opposite)];
        const double area_a = cross(b - a, c - a), area_d = cross(c - d, b - d);
        const double scale = (c - b).squaredNorm();
        if (cross(b - a, d - a) <= 1e-6 * scale || cross(d - a, c - a) <= 1e-6 * scale) continue;
        const double cotangents = (b - a).dot(c - a) * area_d + (c - d).dot(b - d) * area_a;
        if (cotangents >= -kMargin * area_a * area_d) continue;
        mesh.flip(t, i);
        flipped = true;
      }
    }
    if (!flipped) return;
  }
}

}  // namespace toile
