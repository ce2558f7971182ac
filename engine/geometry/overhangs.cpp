#include "engine/geometry/overhangs.h"

#include "engine/geometry/solid_surface.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace toile {

namespace {

constexpr double kFootHeight = 0.05;   ///< [m] above the lowest point in which paths begin
constexpr double kLeastHeight = 0.10;  ///< [m] of a part that is cut off
constexpr int kGroupReach = 2;         ///< nodes between which hanging pieces are one part
/// Nodes outside that take the label of the inside beside them: level with it, to keep the cut a plane, and around it,
/// as far as a finger too thin to hold a node.
constexpr int kLevelLayers = 3, kAroundLayers = 10;

enum Label : char { unknown, standing, hanging };

using NodeIndex = std::array<int, 3>;

struct Labels {
  Lattice lattice;
  std::vector<char> at;

  bool contains(const NodeIndex& n) const {
    for (int k = 0; k < 3; ++k) {
      if (n[k] < 0 || n[k] >= lattice.nodes[k]) return false;
    }
    return true;
  }
  char& operator[](const NodeIndex& n) { return at[lattice.index(n[0], n[1], n[2])]; }
  char operator[](const NodeIndex& n) const { return at[lattice.index(n[0], n[1], n[2])]; }

  bool is_hanging(const Vec3& point) const {
    const Vec3 place = (point - lattice.origin) / lattice.spacing;
    NodeIndex n;
    for (int k = 0; k < 3; ++k) n[k] = std::clamp(static_cast<int>(std::lround(place[k])), 0, lattice.nodes[k] - 1);
    return (*this)[n] == hanging;
  }
};

constexpr std::array<NodeIndex, 4> kSideways{{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}}};
constexpr std::array<NodeIndex, 6> kAround{{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}}};

NodeIndex plus(const NodeIndex& a, const NodeIndex& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

template <typename Visit>
void for_each_node(const Lattice& lattice, Visit&& visit) {
  for (int k = 0; k < lattice.nodes[2]; ++k) {
    for (int j = 0; j < lattice.nodes[1]; ++j) {
      for (int i = 0; i < lattice.nodes[0]; ++i) visit(NodeIndex{i, j, k});
    }
  }
}

/// Everything inside is hanging at first; what the feet reach is standing.
Labels reached_from_below(const DistanceGrid& grid) {
  Labels labels{grid.coarse(), {}};
  labels.at.assign(labels.lattice.size(), unknown);
  int lowest = labels.lattice.nodes[1];
  for_each_node(labels.lattice, [&](const NodeIndex& n) {
    const size_t index = labels.lattice.index(n[0], n[1], n[2]);
    if (grid.coarse_value(index) >= 0) return;
    labels.at[index] = hanging;
    lowest = std::min(lowest, n[1]);
  });
  const int feet = lowest + static_cast<int>(kFootHeight / labels.lattice.spacing);
  std::vector<NodeIndex> front;
  const auto reach = [&](const NodeIndex& n) {
    if (!labels.contains(n) || labels[n] != hanging) return;
    labels[n] = standing;
    front.push_back(n);
  };
  for_each_node(labels.lattice, [&](const NodeIndex& n) {
    if (n[1] <= feet) reach(n);
  });
  while (!front.empty()) {
    const NodeIndex n = front.back();
    front.pop_back();
    reach(plus(n, {0, 1, 0}));
    for (const NodeIndex& step : kSideways) reach(plus(n, step));
  }
  return labels;
}

/// Gives low groups that hang right beside what stands (a chin, not a finger) back to it. False if no group is left.
bool keep_groups(Labels& labels) {
  std::vector<char> visited(labels.at.size(), 0);
  bool any = false;
  for_each_node(labels.lattice, [&](const NodeIndex& seed) {
    if (labels[seed] != hanging || visited[labels.lattice.index(seed[0], seed[1], seed[2])]) return;
    std::vector<NodeIndex> group{seed};
    visited[labels.lattice.index(seed[0], seed[1], seed[2])] = 1;
    int low = seed[1], high = seed[1];
    bool beside_standing = false;
    for (size_t next = 0; next < group.size(); ++next) {
      low = std::min(low, group[next][1]);
      high = std::max(high, group[next][1]);
      for (int dz = -kGroupReach; dz <= kGroupReach; ++dz) {
        for (int dy = -kGroupReach; dy <= kGroupReach; ++dy) {
          for (int dx = -kGroupReach; dx <= kGroupReach; ++dx) {
            const NodeIndex n = plus(group[next], {dx, dy, dz});
            if (!labels.contains(n)) continue;
            if (labels[n] == standing) beside_standing = true;
            if (labels[n] != hanging) continue;
            char& seen = visited[labels.lattice.index(n[0], n[1], n[2])];
            if (seen) continue;
            seen = 1;
            group.push_back(n);
          }
        }
      }
    }
    if (!beside_standing || (high - low + 1) * labels.lattice.spacing >= kLeastHeight) {
      any = true;
    } else {
      for (const NodeIndex& n : group) labels[n] = standing;
    }
  });
  return any;
}

/// Spreads the labels a few nodes outwards, first level (so that the cut stays a plane), then around.
void spread_outwards(Labels& labels) {
  std::vector<NodeIndex> front, next;
  for_each_node(labels.lattice, [&](const NodeIndex& n) {
    if (labels[n] != unknown) front.push_back(n);
  });
  const auto spread = [&](std::span<const NodeIndex> steps, int layers) {
    for (int layer = 0; layer < layers; ++layer) {
      next.clear();
      for (const NodeIndex& n : front) {
        for (const NodeIndex& step : steps) {
          const NodeIndex m = plus(n, step);
          if (!labels.contains(m) || labels[m] != unknown) continue;
          labels[m] = labels[n];
          next.push_back(m);
        }
      }
      front.swap(next);
    }
  };
  spread(kSideways, kLevelLayers);
  front.clear();
  for_each_node(labels.lattice, [&](const NodeIndex& n) {
    if (labels[n] != unknown) front.push_back(n);
  });
  spread(kAround, kAroundLayers);
}

void append(SoupSolid& solid, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int first = static_cast<int>(solid.vertices.size());
  solid.vertices.insert(solid.vertices.end(), {a, b, c});
  solid.triangles.push_back({first, first + 1, first + 2});
}

/// Small squares facing down wherever a standing node lies on a hanging one, within the solid.
void close_cut(const Labels& labels, const SoupSolid& whole, double smallest, SoupSolid& cut) {
  const double spacing = labels.lattice.spacing;
  const int parts = static_cast<int>(std::ceil(spacing / smallest));
  const double side = spacing / parts;
  for_each_node(labels.lattice, [&](const NodeIndex& n) {
    if (n[1] == 0 || labels[n] != standing || labels[plus(n, {0, -1, 0})] != hanging) return;
    const Vec3 corner = labels.lattice.point(n[0], n[1], n[2]).array() - 0.5 * spacing;
    for (int a = 0; a < parts; ++a) {
      for (int b = 0; b < parts; ++b) {
        const Vec3 p = corner + Vec3(a * side, 0, b * side), x(side, 0, 0), z(0, 0, side);
        if (!whole.inside(p + 0.5 * (x + z))) continue;
        append(cut, p, p + x, p + x + z);
        append(cut, p, p + x + z, p + z);
      }
    }
  });
}

}  // namespace

std::optional<SoupSolid> cut_overhangs(const SoupSolid& solid, const DistanceGrid& grid) {
  auto labels = std::make_shared<Labels>(reached_from_below(grid));
  if (!keep_groups(*labels)) return std::nullopt;
  spread_outwards(*labels);

  SoupSolid cut;
  const double smallest = 0.5 * grid.settings().fine_spacing;
  const auto stands = [&](const Vec3& point, const Vec3&) { return !labels->is_hanging(point); };
  for (const auto& [a, b, c] : solid.triangles) {
    keep_where(solid.vertices[a], solid.vertices[b], solid.vertices[c], stands, 2 * grid.settings().coarse_spacing,
               smallest, [&](const Vec3& x, const Vec3& y, const Vec3& z) { append(cut, x, y, z); });
  }
  close_cut(*labels, solid, smallest, cut);
  cut.inside = [labels = std::shared_ptr<const Labels>(labels), inside = solid.inside](const Vec3& p) {
    return inside(p) && !labels->is_hanging(p);
  };
  return cut;
}

}  // namespace toile
