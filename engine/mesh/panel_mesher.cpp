#include "engine/mesh/panel_mesher.h"

#include "engine/mesh/plane_mesh.h"
#include "engine/mesh/polygon.h"
#include "engine/mesh/seed_lattice.h"
#include "engine/scene/problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace toile {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr int kRelaxations = 25;  // sweeps; 25 leave the worst angles within 1° of what 100 reach
constexpr int kRepairs = 5;       // rounds of removing crowded points and filling holes
constexpr double kPoorAngle = 28 * kDegree;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Work {
  PlaneMesh mesh;
  int outline_size;
  double h;

  const Vec2& point(int vertex) const { return mesh.points[static_cast<std::size_t>(vertex)]; }
  bool inner(int vertex) const { return vertex >= outline_size; }

  /// The triangles around an inner vertex (its star is closed).
  void star(int vertex, std::vector<int>& triangles) const {
    triangles.clear();
    const int start = mesh.triangle_at[static_cast<std::size_t>(vertex)];
    int t = start;
    do {
      triangles.push_back(t);
      const Triangle& v = mesh.triangles[static_cast<std::size_t>(t)];
      const auto i = static_cast<std::size_t>(std::find(v.begin(), v.end(), vertex) - v.begin());
      t = mesh.neighbours[static_cast<std::size_t>(t)][(i + 1) % 3];
    } while (t != start);
  }

  /// Smallest angle around a vertex if it were at `place`; negative if a triangle would turn over.
  double star_quality(const std::vector<int>& triangles, int vertex, const Vec2& place) const {
    double worst = M_PI;
    for (const int t : triangles) {
      std::array<Vec2, 3> p;
      for (std::size_t i = 0; i < 3; ++i) {
        const int v = mesh.triangles[static_cast<std::size_t>(t)][i];
        p[i] = v == vertex ? place : point(v);
      }
      if (cross(p[1] - p[0], p[2] - p[0]) <= 0) return -1;
      worst = std::min(worst, smallest_angle(p[0], p[1], p[2]));
    }
    return worst;
  }
};

Vec2 circumcenter(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  const double twice_cross = 2 * cross(u, v);
  return a +
         Vec2(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(), u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) /
             twice_cross;
}

/// One sweep of optimal Delaunay smoothing: each inner vertex to the area-weighted mean of the circumcentres around it.
void relax(Work& work, std::vector<int>& star) {
  for (int vertex = work.outline_size; vertex < static_cast<int>(work.mesh.points.size()); ++vertex) {
    work.star(vertex, star);
    Vec2 sum = Vec2::Zero();
    double total = 0;
    for (const int t : star) {
      const Triangle& v = work.mesh.triangles[static_cast<std::size_t>(t)];
      const Vec2 &a = work.point(v[0]), &b = work.point(v[1]), &c = work.point(v[2]);
      const double area = cross(b - a, c - a);
      sum += area * circumcenter(a, b, c);
      total += area;
    }
    const Vec2 from = work.point(vertex);
    Vec2 step = sum / total - from;
    if (step.norm() > 0.3 * work.h) step *= 0.3 * work.h / step.norm();
    const double before = work.star_quality(star, vertex, from);
    for (int halving = 0; halving < 3; ++halving, step /= 2) {
      const double after = work.star_quality(star, vertex, from + step);
      if (after > std::min(before, kPoorAngle)) {
        work.mesh.points[static_cast<std::size_t>(vertex)] = from + step;
        break;
      }
    }
  }
}

/// Hill climbing on the smallest angle, for the few vertices around poor triangles.
void polish(Work& work, std::vector<int>& star) {
  for (int sweep = 0; sweep < 12; ++sweep) {
    bool moved = false;
    for (int vertex = work.outline_size; vertex < static_cast<int>(work.mesh.points.size()); ++vertex) {
      work.star(vertex, star);
      double best = work.star_quality(star, vertex, work.point(vertex));
      if (best > kPoorAngle) continue;
      for (double reach = 0.2 * work.h; reach > 0.005 * work.h; reach /= 2) {
        const Vec2 from = work.point(vertex);
        for (int direction = 0; direction < 8; ++direction) {
          const double angle = direction * M_PI / 4;
          const Vec2 place = from + reach * Vec2(std::cos(angle), std::sin(angle));
          const double quality = work.star_quality(star, vertex, place);
          if (quality > best + 1e-6) {
            best = quality;
            work.mesh.points[static_cast<std::size_t>(vertex)] = place;
            moved = true;
          }
        }
      }
    }
    flip_to_delaunay(work.mesh);
    if (!moved) return;
  }
}

std::array<double, 3> angles(const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto angle = [](const Vec2& u, const Vec2& v) { return std::atan2(std::abs(cross(u, v)), u.dot(v)); };
  return {angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)};
}

/// Poor triangles that moving points could still cure.
int count_poor(const Work& work) {
  int poor = 0;
  for (const Triangle& v : work.mesh.triangles) {
    const bool fixed = !work.inner(v[0]) && !work.inner(v[1]) && !work.inner(v[2]);
    if (!fixed && smallest_angle(work.point(v[0]), work.point(v[1]), work.point(v[2])) < kPoorAngle) ++poor;
  }
  return poor;
}

/// The next set of inner points: without those that crowd, with new ones in triangles too wide. Empty optional-like
/// flag `changed` tells whether it differs.
std::vector<Vec2> repaired_points(const Work& work, const SeedLattice& lattice, bool& changed) {
  const std::size_t count = work.mesh.points.size();
  std::vector<char> removed(count, 0), touched(count, 0);
  std::vector<Vec2> added;
  for (const Triangle& v : work.mesh.triangles) {
    const std::array<Vec2, 3> p = {work.point(v[0]), work.point(v[1]), work.point(v[2])};
    const std::array<double, 3> corner = angles(p[0], p[1], p[2]);
    const bool busy = touched[static_cast<std::size_t>(v[0])] || touched[static_cast<std::size_t>(v[1])] ||
                      touched[static_cast<std::size_t>(v[2])];
    if (busy) continue;
    const auto widest = static_cast<std::size_t>(std::max_element(corner.begin(), corner.end()) - corner.begin());
    const auto sharpest = static_cast<std::size_t>(std::min_element(corner.begin(), corner.end()) - corner.begin());
    int victim = -1;
    if (corner[sharpest] < kPoorAngle && corner[widest] > 115 * kDegree && work.inner(v[widest])) victim = v[widest];
    if (victim < 0 && corner[sharpest] < kPoorAngle) {
      const int s = v[(sharpest + 1) % 3], e = v[(sharpest + 2) % 3];
      if ((work.point(s) - work.point(e)).norm() < 0.6 * work.h) victim = work.inner(s) ? s : work.inner(e) ? e : -1;
    }
    const Vec2 center = (p[0] + p[1] + p[2]) / 3;
    const double reach = std::min({(p[0] - center).norm(), (p[1] - center).norm(), (p[2] - center).norm()});
    const double radius = (circumcenter(p[0], p[1], p[2]) - p[0]).norm();
    if (victim >= 0) {
      removed[static_cast<std::size_t>(victim)] = 1;
    } else if (radius > 0.85 * work.h && reach > 0.55 * work.h && lattice.clear(center, 0.4 * work.h)) {
      added.push_back(center);
    } else {
      continue;
    }
    for (const int vertex : v) touched[static_cast<std::size_t>(vertex)] = 1;
    if (victim >= 0) touched[static_cast<std::size_t>(victim)] = 1;
  }
  std::vector<Vec2> points;
  for (std::size_t i = static_cast<std::size_t>(work.outline_size); i < count; ++i) {
    if (!removed[i]) points.push_back(work.mesh.points[i]);
  }
  changed = points.size() + static_cast<std::size_t>(work.outline_size) != count || !added.empty();
  points.insert(points.end(), added.begin(), added.end());
  return points;
}

Work relaxed(const std::vector<Vec2>& outline, const std::vector<Vec2>& inner, double h) {
  Work work{constrained_delaunay(outline, inner), static_cast<int>(outline.size()), h};
  std::vector<int> star;
  if (inner.empty()) return work;
  for (int sweep = 0; sweep < kRelaxations; ++sweep) {
    relax(work, star);
    flip_to_delaunay(work.mesh);
  }
  return work;
}

Work mesh_counter_clockwise(const std::vector<Vec2>& outline, double h) {
  const SeedLattice lattice(outline, h);
  std::vector<Vec2> inner = lattice.seeds();
  Work best = relaxed(outline, inner, h);
  int best_poor = count_poor(best);
  Work current = best;
  for (int round = 0; round < kRepairs; ++round) {
    bool changed = false;
    inner = repaired_points(current, lattice, changed);
    if (!changed) break;
    current = relaxed(outline, inner, h);
    const int poor = count_poor(current);
    if (poor <= best_poor) {
      best = current;
      best_poor = poor;
    }
  }
  std::vector<int> star;
  if (best_poor > 0) polish(best, star);
  return best;
}

}  // namespace

double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c) {
  const std::array<double, 3> corner = angles(a, b, c);
  return std::min({corner[0], corner[1], corner[2]});
}

FlatMesh mesh_polygon(const std::vector<Vec2>& outline, double edge_length, const std::string& pointer) {
  const std::size_t n = outline.size();
  if (n < 3) throw InputError(pointer, "panel_too_small", "the panel's outline has fewer than three points");
  const double area = polygon_area(outline);
  double perimeter = 0;
  for (std::size_t i = 0; i < n; ++i) perimeter += (outline[(i + 1) % n] - outline[i]).norm();
  // A thousandth of a millimetre of width is no cloth.
  if (!(std::abs(area) > 1e-6 * perimeter / 2)) {
    throw InputError(pointer, "zero_area_panel", "the panel has no area");
  }
  if (first_crossing(outline)) {
    throw InputError(pointer, "self_crossing_panel", "the panel's outline crosses or touches itself");
  }
  std::vector<Vec2> ring = outline;
  if (area < 0) std::reverse(ring.begin(), ring.end());
  Work work;
  try {
    work = mesh_counter_clockwise(ring, edge_length);
  } catch (const std::runtime_error&) {
    throw InputError(pointer, "self_crossing_panel", "the panel's outline touches itself");
  }
  FlatMesh mesh{std::move(work.mesh.points), std::move(work.mesh.triangles)};
  if (area < 0) {
    std::copy(outline.begin(), outline.end(), mesh.vertices.begin());
    for (Triangle& triangle : mesh.triangles) {
      for (int& vertex : triangle) {
        if (vertex < static_cast<int>(n)) vertex = static_cast<int>(n) - 1 - vertex;
      }
    }
  }
  return mesh;
}

}  // namespace toile
