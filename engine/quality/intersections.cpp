#include "engine/quality/intersections.h"

#include "engine/quality/exact_sign.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace toile {

namespace {

using Corners = std::array<Vec3, 3>;

Vec2 dropped(const Vec3& p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

int orientation_without(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  return orientation_sign(dropped(a, axis), dropped(b, axis), dropped(c, axis));
}

/// An axis along which the triangle's projection keeps an area, or -1.
int projection_axis(const Corners& t) {
  Vec3::Index largest;
  (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs().maxCoeff(&largest);
  for (int k = 0; k < 3; ++k) {
    const int axis = (static_cast<int>(largest) + k) % 3;
    if (orientation_without(axis, t[0], t[1], t[2]) != 0) return axis;
  }
  return -1;
}

bool on_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  return (p.array() >= a.cwiseMin(b).array()).all() && (p.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int abc = orientation_sign(a, b, c), abd = orientation_sign(a, b, d);
  const int cda = orientation_sign(c, d, a), cdb = orientation_sign(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && on_segment(c, a, b)) || (abd == 0 && on_segment(d, a, b)) || (cda == 0 && on_segment(a, c, d)) ||
         (cdb == 0 && on_segment(b, c, d));
}

bool coplanar_segment_meets(const Vec3& p, const Vec3& q, const Corners& t) {
  const int axis = projection_axis(t);
  const Vec2 p2 = dropped(p, axis), q2 = dropped(q, axis);
  const std::array<Vec2, 3> c{dropped(t[0], axis), dropped(t[1], axis), dropped(t[2], axis)};
  const int winding = orientation_sign(c[0], c[1], c[2]);
  bool p_inside = true;
  for (int k = 0; k < 3; ++k) {
    const Vec2 &a = c[k], &b = c[(k + 1) % 3];
    if (segments_meet(p2, q2, a, b)) return true;
    if (winding * orientation_sign(a, b, p2) < 0) p_inside = false;
  }
  return p_inside;
}

/// Closed segment against closed triangle of some area; side_p and side_q are the ends' sides of the triangle's plane.
bool segment_meets(const Vec3& p, const Vec3& q, int side_p, int side_q, const Corners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return coplanar_segment_meets(p, q, t);
  int low = 0, high = 0;
  for (int k = 0; k < 3; ++k) {
    const int side = orientation_sign(p, q, t[k], t[(k + 1) % 3]);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  return low == 0 || high == 0;
}

/// Of the corners from `first` on; those before it are shared, on the plane.
std::array<int, 3> sides(const Corners& plane, const Corners& of, int first = 0) {
  std::array<int, 3> side{};
  for (int k = first; k < 3; ++k) side[k] = orientation_sign(plane[0], plane[1], plane[2], of[k]);
  return side;
}

bool same_strict_side(const std::array<int, 3>& s) { return s[0] != 0 && s[0] == s[1] && s[1] == s[2]; }

/// Neither shares a vertex with the other.
bool apart_cross(const Corners& a, const Corners& b) {
  const std::array<int, 3> b_of_a = sides(a, b);
  if (same_strict_side(b_of_a)) return false;
  const std::array<int, 3> a_of_b = sides(b, a);
  if (same_strict_side(a_of_b)) return false;
  for (int k = 0; k < 3; ++k) {
    const int n = (k + 1) % 3;
    if (segment_meets(b[k], b[n], b_of_a[k], b_of_a[n], a)) return true;
    if (segment_meets(a[k], a[n], a_of_b[k], a_of_b[n], b)) return true;
  }
  return false;
}

/// Both begin with the shared vertex. The common part is then a point, or reaches the far edge of one of them.
bool fan_cross(const Corners& a, const Corners& b) {
  const std::array<int, 3> b_of_a = sides(a, b, 1);
  if (b_of_a[1] * b_of_a[2] > 0) return false;
  const std::array<int, 3> a_of_b = sides(b, a, 1);
  if (a_of_b[1] * a_of_b[2] > 0) return false;
  return segment_meets(b[1], b[2], b_of_a[1], b_of_a[2], a) || segment_meets(a[1], a[2], a_of_b[1], a_of_b[2], b);
}

/// Both begin with the shared edge, in the same direction.
bool folded_flat(const Corners& a, const Corners& b) {
  if (orientation_sign(a[0], a[1], a[2], b[2]) != 0) return false;
  const int axis = projection_axis(a);
  return orientation_without(axis, a[0], a[1], a[2]) == orientation_without(axis, a[0], a[1], b[2]);
}

/// Uniform grid over the triangles' boxes.
struct Grid {
  Vec3 origin;
  double cell;
  std::array<int, 3> at(const Vec3& p) const {
    std::array<int, 3> index;
    for (int k = 0; k < 3; ++k) index[k] = static_cast<int>((p[k] - origin[k]) / cell);
    return index;
  }
};

struct CellEntry {
  std::uint64_t cell;
  int triangle;
  bool operator<(const CellEntry& o) const { return cell < o.cell || (cell == o.cell && triangle < o.triangle); }
};

constexpr double kMostCellsAcross = 1 << 20;  ///< of the grid: an index takes 21 bits
constexpr double kMostCellsPerTriangle = 16;  ///< along one axis: bounds the memory of a few huge triangles

std::uint64_t cell_key(int i, int j, int k) {
  return static_cast<std::uint64_t>(k) << 42 | static_cast<std::uint64_t>(j) << 21 | static_cast<std::uint64_t>(i);
}

}  // namespace

bool triangles_cross(const Positions& x, const Triangle& first, const Triangle& second) {
  std::array<int, 3> p = first, q = second;
  int shared = 0;
  for (int i = 0; i < 3; ++i) {
    const auto in_second = std::find(q.begin() + shared, q.end(), p[i]);
    if (in_second == q.end()) continue;
    std::iter_swap(q.begin() + shared, in_second);
    std::swap(p[shared], p[i]);
    ++shared;
  }
  const Corners a{x[p[0]], x[p[1]], x[p[2]]}, b{x[q[0]], x[q[1]], x[q[2]]};
  if (projection_axis(a) < 0 || projection_axis(b) < 0) return false;
  switch (shared) {
    case 0:
      return apart_cross(a, b);
    case 1:
      return fan_cross(a, b);
    case 2:
      return folded_flat(a, b);
    default:
      return true;
  }
}

std::vector<TrianglePair> self_intersections(const Positions& x, const std::vector<Triangle>& triangles) {
  struct Extent {
    Vec3 lower, upper;
  };
  const int count = static_cast<int>(triangles.size());
  std::vector<Extent> extents(count);
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::max()), upper = -lower;
  double mean = 0, largest = 0;
  for (int t = 0; t < count; ++t) {
    const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
    extents[t] = {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
    lower = lower.cwiseMin(extents[t].lower);
    upper = upper.cwiseMax(extents[t].upper);
    const double size = (extents[t].upper - extents[t].lower).maxCoeff();
    mean += size / count;
    largest = std::max(largest, size);
  }
  if (count == 0) return {};
  const double cell = std::max({mean, largest / kMostCellsPerTriangle, (upper - lower).maxCoeff() / kMostCellsAcross,
                                std::numeric_limits<double>::min()});
  const Grid grid{lower, cell};
  std::vector<CellEntry> entries;
  entries.reserve(8 * static_cast<size_t>(count));
  for (int t = 0; t < count; ++t) {
    const std::array<int, 3> low = grid.at(extents[t].lower), high = grid.at(extents[t].upper);
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) entries.push_back({cell_key(i, j, k), t});
      }
    }
  }
  std::sort(entries.begin(), entries.end());

  std::vector<TrianglePair> pairs;
  for (size_t begin = 0; begin < entries.size();) {
    size_t end = begin;
    while (end < entries.size() && entries[end].cell == entries[begin].cell) ++end;
    for (size_t i = begin; i < end; ++i) {
      const int a = entries[i].triangle;
      for (size_t j = i + 1; j < end; ++j) {
        const int b = entries[j].triangle;
        const Vec3 low = extents[a].lower.cwiseMax(extents[b].lower);
        if ((low.array() > extents[a].upper.cwiseMin(extents[b].upper).array()).any()) continue;
        // Two boxes may share many cells; the one that holds the first corner of their overlap answers for the pair.
        const std::array<int, 3> home = grid.at(low);
        if (cell_key(home[0], home[1], home[2]) != entries[begin].cell) continue;
        if (triangles_cross(x, triangles[a], triangles[b])) pairs.push_back({a, b});
      }
    }
    begin = end;
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const TrianglePair& p, const TrianglePair& q) { return p.a < q.a || (p.a == q.a && p.b < q.b); });
  return pairs;
}

}  // namespace toile
