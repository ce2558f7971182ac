#include "engine/solve/pleats.h"

#include "engine/geometry/mean.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/topology.h"
#include "engine/quality/intersections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace toile {
namespace {

constexpr double kStraight = 1.35;   // outline between a pair's ends by their distance: more goes round a dart
constexpr double kSameFold = 0.5;    // of an edge, between the middles of pairs of one fold; shallower ones are none
constexpr double kMatching = 1.5;    // between the depths of a pleat's two folds and their distance, either way
constexpr double kShallowest = 1.1;  // of an edge: a pleat no deeper than its triangles can't be laid in layers
constexpr double kDrop = 0.15;       // of an edge, from the first layer of a pleat to the third

constexpr double kNear = 15e-3;  // [m] folding has brought a pair together

/// Where the outline is mapped onto itself.
struct Fold {
  double middle = 0;  // along the outline [m]
  double depth = 0;   // [m]
  Vec3 at = Vec3::Zero(), way = Vec3::Zero();
  int pairs = 0;
};

/// A line in the panel's plane; `beyond` is a unit normal to it, to the side that folding moves.
struct Line {
  Vec3 at, beyond;
  double side(const Vec3& p) const { return beyond.dot(p - at); }
  Vec3 mirrored(const Vec3& p) const { return p - 2 * side(p) * beyond; }
};

/// Two folds of one pleat, the first before the second.
struct Pleat {
  Line first, second;
  double depth = 0;  // between them [m]
};

struct Outline {
  std::map<int, double> place;  // vertex → way along the loop [m]
  double length = 0;

  Outline(const std::vector<int>& vertices, const Positions& x) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      place[vertices[i]] = length;
      length += (x[vertices[(i + 1) % vertices.size()]] - x[vertices[i]]).norm();
    }
  }
};

/// The pair as a fold of the outline, if the outline runs straight from one to the other.
std::optional<Fold> fold_of(const Outline& outline, const Positions& x, int a, int b) {
  const auto pa = outline.place.find(a), pb = outline.place.find(b);
  if (pa == outline.place.end() || pb == outline.place.end() || a == b) return std::nullopt;
  double from = pa->second, to = pb->second;
  if (from > to) std::swap(from, to), std::swap(a, b);
  if (to - from > 0.5 * outline.length) {
    std::swap(a, b);
    std::swap(from, to);
    to += outline.length;
  }
  const Vec3 way = x[b] - x[a];
  if (to - from > kStraight * way.norm()) return std::nullopt;
  return Fold{0.5 * (from + to), 0.5 * (to - from), 0.5 * (x[a] + x[b]), way, 1};
}

std::vector<Fold> folds_of(const Outline& outline, const Positions& x, const std::vector<SeamPair>& pairs,
                           double edge_length) {
  std::vector<Fold> single;
  for (const SeamPair& pair : pairs)
    if (const std::optional<Fold> fold = fold_of(outline, x, pair.a, pair.b))
      if (fold->depth > kSameFold * edge_length) single.push_back(*fold);
  std::stable_sort(single.begin(), single.end(), [](const Fold& a, const Fold& b) { return a.middle < b.middle; });
  std::vector<Fold> folds;
  for (const Fold& fold : single) {
    if (folds.empty() || fold.middle - folds.back().middle / folds.back().pairs > kSameFold * edge_length) {
      folds.push_back(fold);
      continue;
    }
    Fold& same = folds.back();
    same.middle += fold.middle;
    same.at += fold.at;
    same.way += fold.way;
    same.depth = std::max(same.depth, fold.depth);
    ++same.pairs;
  }
  for (Fold& fold : folds) {
    fold.middle /= fold.pairs;
    fold.at /= fold.pairs;
  }
  return folds;
}

/// Folds beside each other, two by two, in the order of the outline.
std::vector<Pleat> pleats_of(const std::vector<Fold>& folds, const Vec3& normal) {
  const auto line = [&](const Fold& fold) {
    return Line{fold.at, (fold.way - normal * normal.dot(fold.way)).normalized()};
  };
  std::vector<Pleat> pleats;
  for (std::size_t i = 0; i + 1 < folds.size(); ++i) {
    const double between = folds[i + 1].middle - folds[i].middle;
    const auto [shallow, deep] = std::minmax(folds[i].depth, folds[i + 1].depth);
    if (between > kMatching * shallow || deep > kMatching * between) continue;
    pleats.push_back({line(folds[i]), line(folds[i + 1]), between});
    ++i;
  }
  return pleats;
}

/// How the lines of the pleats run: as their pairs say, which brings those together exactly; parallel in each pleat; or
/// parallel in the panel, for lines that would meet in it otherwise.
enum class Direction { own, pleat, panel };

std::vector<Pleat> directed(std::vector<Pleat> pleats, Direction direction) {
  Vec3 common = Vec3::Zero();
  for (const Pleat& pleat : pleats) common += pleat.first.beyond + pleat.second.beyond;
  for (Pleat& pleat : pleats) {
    if (direction == Direction::own) break;
    const Vec3 way = direction == Direction::pleat ? pleat.first.beyond + pleat.second.beyond : common;
    pleat.first.beyond = pleat.second.beyond = way.normalized();
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

/// Where folding brings a point, in the plane: last folds first, while what comes before them is still flat.
Vec3 folded(const std::vector<Pleat>& pleats, const Vec3& flat) {
  Vec3 p = flat;
  for (auto pleat = pleats.rbegin(); pleat != pleats.rend(); ++pleat)
    for (const Line* line : {&pleat->second, &pleat->first})
      if (line->side(flat) > 0) p = line->mirrored(p);
  return p;
}

/// How far down its layer lies, in drops of a pleat: it rises all the way, so that no layer meets another.
double layer_of(const std::vector<Pleat>& pleats, const Vec3& p) {
  double layer = 0;
  for (const Pleat& pleat : pleats) {
    const double s = pleat.first.side(p), t = pleat.second.side(p);
    if (s <= 0)
      layer += std::max(0.0, s / pleat.depth + 1) / 3;
    else if (t <= 0)
      layer += (1 + s / (s - t)) / 3;
    else
      layer += (2 + std::min(1.0, t / pleat.depth)) / 3;
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

/// Whether the surface crosses itself once each set of `closed` is one vertex.
bool crosses(const Positions& x, const std::vector<Triangle>& triangles, const std::vector<int>& closed) {
  std::vector<Triangle> sewn = triangles;
  std::map<Triangle, int> times;  // two at the tip of a fold come to lie on each other (see merge_seams)
  for (Triangle& t : sewn) {
    for (int& v : t) v = closed[v];
    std::sort(t.begin(), t.end());
    ++times[t];
  }
  std::erase_if(sewn, [&](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || times[t] > 1; });
  return !self_intersections(x, sewn).empty();
}

/// Moves the vertices of each set to their mean: all sets at once, or as many as nothing crosses with.
void close_sets(std::vector<std::vector<int>> sets, const std::vector<Triangle>& triangles, Positions& x) {
  std::vector<int> closed(x.size());
  std::iota(closed.begin(), closed.end(), 0);
  const auto close = [&](const std::vector<std::vector<int>>& chosen) {
    Positions tried = x;
    std::vector<int> with = closed;
    for (const std::vector<int>& set : chosen) {
      const Vec3 mean = mean_of(x, set);
      for (int v : set) {
        tried[v] = mean;
        with[v] = set.front();
      }
    }
    if (crosses(tried, triangles, with)) return false;
    x = std::move(tried);
    closed = std::move(with);
    return true;
  };
  // One set may stand in the way of another until it is closed itself.
  for (std::size_t before = sets.size() + 1; !sets.empty() && sets.size() < before;) {
    before = sets.size();
    if (close(sets)) return;
    std::erase_if(sets, [&](const std::vector<int>& set) { return close({set}); });
  }
}

}  // namespace

void fold_pleats(Cloth& apart) {
  std::vector<std::vector<Triangle>> triangles(apart.panels.size());
  for (std::size_t t = 0; t < apart.triangles.size(); ++t)
    triangles[apart.triangle_panel[t]].push_back(apart.triangles[t]);
  const std::vector<int> panel_of_vertex = panel_of_vertices(apart);
  std::vector<std::vector<int>> vertices(apart.panels.size());
  for (std::size_t v = 0; v < apart.x.size(); ++v)
    if (panel_of_vertex[v] >= 0) vertices[panel_of_vertex[v]].push_back(static_cast<int>(v));
  std::vector<std::vector<SeamPair>> own(apart.panels.size());
  for (const SeamPair& pair : apart.seam_pairs)
    if (panel_of_vertex[pair.a] >= 0 && panel_of_vertex[pair.a] == panel_of_vertex[pair.b])
      own[panel_of_vertex[pair.a]].push_back(pair);

  for (std::size_t p = 0; p < apart.panels.size(); ++p) {
    if (own[p].empty()) continue;
    Vec3 normal = Vec3::Zero();
    for (const Triangle& t : triangles[p])
      normal += (apart.x[t[1]] - apart.x[t[0]]).cross(apart.x[t[2]] - apart.x[t[0]]);
    normal.normalize();
    for (const std::vector<int>& loop : boundary_loops(triangles[p])) {
      const std::vector<Fold> folds = folds_of(Outline(loop, apart.x), apart.x, own[p], apart.panels[p].edge_length);
      const std::vector<Pleat> found = pleats_of(folds, normal);
      if (found.empty() || std::any_of(found.begin(), found.end(), [&](const Pleat& pleat) {
            return pleat.depth < kShallowest * apart.panels[p].edge_length;
          }))
        continue;
      Positions panel;
      for (int v : vertices[p]) panel.push_back(apart.x[v]);
      std::vector<Pleat> pleats;
      bool ordered = false;
      for (const Direction direction : {Direction::own, Direction::pleat, Direction::panel}) {
        pleats = directed(found, direction);
        ordered = in_order(pleats, panel);
        if (ordered) break;
      }
      if (!ordered) continue;
      Positions x = apart.x;
      for (int v : vertices[p])
        x[v] =
            folded(pleats, apart.x[v]) - normal * (kDrop * apart.panels[p].edge_length * layer_of(pleats, apart.x[v]));
      if (!self_intersections(x, triangles[p]).empty()) continue;
      close_sets(near_sets(own[p], x), triangles[p], x);
      // Narrower now, the panel goes in its plane to where its seams are to be, or else it may hide its neighbour's
      // edge.
      Vec3 shift = Vec3::Zero();
      int joints = 0;
      for (const SeamPair& pair : apart.seam_pairs)
        for (const auto& [own_end, other_end] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
          if (panel_of_vertex[own_end] == static_cast<int>(p) && panel_of_vertex[other_end] != static_cast<int>(p)) {
            shift += x[other_end] - x[own_end];
            ++joints;
          }
      if (joints == 0) {
        for (int v : vertices[p]) shift += apart.x[v] - x[v];
        joints = static_cast<int>(vertices[p].size());
      }
      shift /= joints;
      shift -= normal * normal.dot(shift);
      for (int v : vertices[p]) x[v] += shift;
      apart.x = std::move(x);
    }
  }
}

}  // namespace toile
