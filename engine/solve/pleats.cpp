#include "engine/solve/pleats.h"

#include "engine/geometry/mean.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/topology.h"
#include "engine/quality/intersections.h"
#include "engine/solve/pleat_folds.h"
#include "engine/solve/pleat_layers.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace toile {
namespace {

constexpr double kShallowest = 1.1;  // of an edge: a pleat no deeper than its triangles can't be laid in layers
constexpr double kDrop = 0.15;       // of an edge, from the first layer of a pleat to the third
constexpr double kSamePlace = 0.5;   // of a pleat's depth: folds that meet after folding
constexpr double kApex = 1.02;       // of the way to the farthest point of the panel
constexpr double kAcross = 4;    // times the depth of the deepest pleat: no seam of a pleat joins what is farther apart
constexpr double kBoxGap = 0.1;  // of an edge, between the two folds that face each other in a box pleat
constexpr double kNear = 15e-3;  // [m] folding has brought a pair together

/// How the lines of the pleats run: as their pairs say, which brings those together exactly; parallel in each pleat;
/// parallel in the panel, for lines that would meet in it otherwise; or towards each other, so that each pleat ends at
/// the panel's other side, which keeps its width.
enum class Direction { own, pleat, panel, tapered };

/// The two lines of a pleat, turned to meet where it would come to the other side of the panel.
void taper(Pleat& pleat, const Vec3& normal, const Positions& panel, double edge_length) {
  const Vec3 across = pleat.first.beyond, middle = 0.5 * (pleat.first.at + pleat.second.at);
  const Vec3 along = normal.cross(across);
  double ahead = 0, behind = 0;
  for (const Vec3& p : panel) {
    if (std::abs(across.dot(p - middle)) > pleat.depth + edge_length) continue;
    ahead = std::max(ahead, along.dot(p - middle));
    behind = std::max(behind, -along.dot(p - middle));
  }
  const Vec3 apex = middle + kApex * (ahead > behind ? ahead : -behind) * along;
  for (Line* line : {&pleat.first, &pleat.second}) {
    const Vec3 way = (apex - line->at).normalized();
    line->beyond = (across - way * way.dot(across)).normalized();
  }
}

std::vector<Pleat> directed(std::vector<Pleat> pleats, Direction direction, const Vec3& normal, const Positions& panel,
                            double edge_length) {
  Vec3 common = Vec3::Zero();
  for (const Pleat& pleat : pleats) common += pleat.first.beyond + pleat.second.beyond;
  for (Pleat& pleat : pleats) {
    if (direction == Direction::own) break;
    const Vec3 way = direction == Direction::pleat ? pleat.first.beyond + pleat.second.beyond : common;
    pleat.first.beyond = pleat.second.beyond = way.normalized();
    if (direction == Direction::tapered) taper(pleat, normal, panel, edge_length);
  }
  return pleats;
}

/// The lines follow one another everywhere in the panel.
bool in_order(const std::vector<Pleat>& pleats, const Positions& panel) {
  return std::all_of(panel.begin(), panel.end(), [&](const Vec3& p) {
    bool before = false;
    for (const Pleat& pleat : pleats)
      for (const Line* line : {&pleat.first, &pleat.second}) {
        if (line->side(p) > 0 && before) return false;
        before = line->side(p) <= 0;
      }
    return true;
  });
}

/// Where folding brings a point, in the plane: last pleats first, while what comes before them is still flat. Where a
/// pleat is no deeper than `thin` [m], triangles are too large to lie in its layers: there what is beyond it moves up
/// as if it were folded, and what is in it is crowded between.
Vec3 folded(const std::vector<Pleat>& pleats, const Vec3& flat, double thin) {
  Vec3 p = flat;
  for (auto pleat = pleats.rbegin(); pleat != pleats.rend(); ++pleat) {
    const double s = pleat->first.side(flat), t = pleat->second.side(flat), depth = std::max(0.0, s - t);
    if (depth < thin) {
      const double before = std::max(2 * depth, thin),
                   share = std::clamp((s + before) / (2 * before + depth), 0.0, 1.0);
      p += share * (pleat->first.mirrored(pleat->second.mirrored(p)) - p);
      continue;
    }
    if (t > 0) p = pleat->second.mirrored(p);
    if (s > 0) p = pleat->first.mirrored(p);
  }
  return p;
}

/// For each pleat 1 if its layers go down, -1 if they come up again. All go down in knife pleats. In a box pleat, the
/// second of two pleats comes up: its last fold lies beside the first one's first.
std::vector<int> ways_of(const std::vector<Pleat>& pleats, bool boxes) {
  std::vector<int> ways(pleats.size(), 1);
  for (std::size_t i = 0; boxes && i + 1 < pleats.size(); ++i) {
    const Vec3 first = folded(pleats, pleats[i].first.at, 0), last = folded(pleats, pleats[i + 1].second.at, 0);
    if (std::abs(pleats[i].first.beyond.dot(first - last)) > kSamePlace * pleats[i].depth) continue;
    ways[++i] = -1;
  }
  return ways;
}

/// How far down a place lies, in drops of a pleat: it changes all the way along the outline, so that no layer of a
/// pleat meets another.
double layer_of(const std::vector<Pleat>& pleats, const std::vector<int>& ways, const Vec3& p) {
  double layer = 0;
  for (std::size_t i = 0; i < pleats.size(); ++i) {
    const Pleat& pleat = pleats[i];
    const double s = pleat.first.side(p), t = pleat.second.side(p);
    if (s <= 0)
      layer += ways[i] * std::max(0.0, s / pleat.depth + 1) / 3;
    else if (t <= 0)
      layer += ways[i] * (1 + s / (s - t)) / 3;
    else
      layer += ways[i] * (2 + std::min(1.0, t / pleat.depth)) / 3;
  }
  return layer;
}

/// What the pairs of folds join and folding has brought near: sets of vertices, ascending.
std::vector<std::vector<int>> near_sets(const std::vector<SeamPair>& pairs, const Positions& x) {
  std::map<int, std::vector<int>> sets;  // by smallest vertex
  std::map<int, int> set_of;
  for (const SeamPair& pair : pairs) {
    if ((x[pair.a] - x[pair.b]).norm() > kNear) continue;
    for (int v : {pair.a, pair.b})
      if (set_of.try_emplace(v, v).second) sets[v] = {v};
    const int into = std::min(set_of[pair.a], set_of[pair.b]), from = std::max(set_of[pair.a], set_of[pair.b]);
    if (into == from) continue;
    for (int v : sets[from]) set_of[v] = into;
    sets[into].insert(sets[into].end(), sets[from].begin(), sets[from].end());
    sets.erase(from);
  }
  std::vector<std::vector<int>> lists;
  for (auto& [first, set] : sets) lists.push_back(std::move(set));
  return lists;
}

/// A panel that is to be folded, with what of it is its own.
struct FlatPanel {
  const Cloth& cloth;
  std::vector<Triangle> triangles;
  std::vector<int> vertices;
  std::vector<SeamPair> own;
  Vec3 normal = Vec3::Zero();
  double edge_length = 0;
};

/// The panel folded, and closed where its pairs have come near if `close`; nothing if it crosses itself then.
std::optional<Positions> laid(const FlatPanel& panel, const std::vector<Pleat>& pleats, const std::vector<int>& ways,
                              bool close) {
  const Positions& flat = panel.cloth.x;
  Positions x = flat;
  for (int v : panel.vertices) x[v] = folded(pleats, flat[v], kShallowest * panel.edge_length);
  FoldedPanel folding{panel.triangles, std::vector<int>(x.size()), std::vector<Vec2>(x.size(), Vec2::Zero()),
                      std::vector<double>(x.size(), 0.0)};
  std::iota(folding.joined.begin(), folding.joined.end(), 0);
  const double drop = kDrop * panel.edge_length;
  for (int v : panel.vertices) folding.height[v] = -drop * layer_of(pleats, ways, flat[v]);
  for (const std::vector<int>& set : close ? near_sets(panel.own, x) : std::vector<std::vector<int>>{}) {
    const Vec3 mean = mean_of(x, set);
    double height = 0;
    for (int v : set) height += folding.height[v] / static_cast<double>(set.size());
    for (int v : set) {
      x[v] = mean;
      folding.height[v] = height;
      folding.joined[v] = set.front();
    }
  }
  const Vec3 along = pleats.front().first.beyond, across = panel.normal.cross(along);
  for (int v : panel.vertices) folding.plane[v] = {along.dot(x[v]), across.dot(x[v])};
  const auto layer = [&](const Triangle& t, const Vec3& weights) {
    return layer_of(pleats, ways, flat[t[0]] * weights[0] + flat[t[1]] * weights[1] + flat[t[2]] * weights[2]);
  };
  if (close) lay_in_order(folding, layer, drop);
  for (int v : panel.vertices) x[v] += panel.normal * folding.height[v];
  std::vector<Triangle> sewn = kept_triangles(folding);
  for (Triangle& t : sewn)
    for (int& v : t) v = folding.joined[v];
  if (!self_intersections(x, sewn).empty()) return std::nullopt;
  return x;
}

/// Sewn to itself elsewhere than at its pleats: a sleeve.
bool is_tube(const FlatPanel& panel, const std::vector<Pleat>& pleats) {
  double deepest = 0;
  for (const Pleat& pleat : pleats) deepest = std::max(deepest, pleat.depth);
  return std::any_of(panel.own.begin(), panel.own.end(), [&](const SeamPair& pair) {
    return (panel.cloth.x[pair.a] - panel.cloth.x[pair.b]).norm() > kAcross * deepest;
  });
}

/// As `laid`, in the first of the ways of folding that does. A tube goes on round what is in it: its pleats taper.
std::optional<Positions> folded_panel(const FlatPanel& panel, const std::vector<Pleat>& found) {
  Positions places;
  for (int v : panel.vertices) places.push_back(panel.cloth.x[v]);
  std::vector<Direction> directions{Direction::own, Direction::pleat, Direction::panel};
  if (is_tube(panel, found)) directions.insert(directions.begin(), Direction::tapered);
  for (const bool close : {true, false})
    for (const Direction direction : directions) {
      std::vector<Pleat> pleats = directed(found, direction, panel.normal, places, panel.edge_length);
      if (!in_order(pleats, places)) continue;
      for (const bool boxes : {false, true}) {
        const std::vector<int> ways = ways_of(pleats, boxes);
        if (boxes && std::count(ways.begin(), ways.end(), -1) == 0) continue;
        for (std::size_t i = 0; i < pleats.size(); ++i)
          if (ways[i] < 0) pleats[i].first.at += 0.5 * kBoxGap * panel.edge_length * pleats[i].first.beyond;
        if (std::optional<Positions> x = laid(panel, pleats, ways, close)) return x;
      }
    }
  return std::nullopt;
}

/// Narrower now, the panel goes in its plane to where its seams are to be, or else it may hide its neighbour's edge.
/// Without seams to others its middle stays.
Vec3 shift_to_seams(const FlatPanel& panel, const std::vector<int>& panel_of_vertex, const Positions& x) {
  Vec3 shift = Vec3::Zero();
  int joints = 0;
  const int own = panel_of_vertex[panel.vertices.front()];
  for (const SeamPair& pair : panel.cloth.seam_pairs)
    for (const auto& [own_end, other_end] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
      if (panel_of_vertex[own_end] == own && panel_of_vertex[other_end] != own) {
        shift += x[other_end] - x[own_end];
        ++joints;
      }
  if (joints == 0) {
    for (int v : panel.vertices) shift += panel.cloth.x[v] - x[v];
    joints = static_cast<int>(panel.vertices.size());
  }
  shift /= joints;
  return shift - panel.normal * panel.normal.dot(shift);
}

std::vector<FlatPanel> panels_of(const Cloth& apart, const std::vector<int>& panel_of_vertex) {
  std::vector<FlatPanel> panels;
  for (const ClothPanel& panel : apart.panels) panels.push_back({apart, {}, {}, {}, Vec3::Zero(), panel.edge_length});
  for (std::size_t t = 0; t < apart.triangles.size(); ++t) {
    const Triangle& v = apart.triangles[t];
    FlatPanel& panel = panels[apart.triangle_panel[t]];
    panel.triangles.push_back(v);
    panel.normal += (apart.x[v[1]] - apart.x[v[0]]).cross(apart.x[v[2]] - apart.x[v[0]]);
  }
  for (FlatPanel& panel : panels) panel.normal.normalize();
  for (std::size_t v = 0; v < apart.x.size(); ++v)
    if (panel_of_vertex[v] >= 0) panels[panel_of_vertex[v]].vertices.push_back(static_cast<int>(v));
  for (const SeamPair& pair : apart.seam_pairs)
    if (panel_of_vertex[pair.a] >= 0 && panel_of_vertex[pair.a] == panel_of_vertex[pair.b])
      panels[panel_of_vertex[pair.a]].own.push_back(pair);
  return panels;
}

}  // namespace

void fold_pleats(Cloth& apart) {
  const std::vector<int> panel_of_vertex = panel_of_vertices(apart);
  for (const FlatPanel& panel : panels_of(apart, panel_of_vertex)) {
    if (panel.own.empty()) continue;
    for (const std::vector<int>& loop : boundary_loops(panel.triangles)) {
      const std::vector<Pleat> pleats = find_pleats(loop, apart.x, panel.own, panel.normal, panel.edge_length);
      if (pleats.empty() || std::any_of(pleats.begin(), pleats.end(), [&](const Pleat& pleat) {
            return pleat.depth < kShallowest * panel.edge_length;
          }))
        continue;
      std::optional<Positions> x = folded_panel(panel, pleats);
      if (!x) continue;
      const Vec3 shift = shift_to_seams(panel, panel_of_vertex, *x);
      for (int v : panel.vertices) (*x)[v] += shift;
      apart.x = std::move(*x);
    }
  }
}

}  // namespace toile
