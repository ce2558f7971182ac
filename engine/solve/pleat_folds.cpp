#include "engine/solve/pleat_folds.h"

#include <algorithm>
#include <map>
#include <optional>

namespace toile {
namespace {

constexpr double kStraight = 1.35;  // outline between a pair's ends by their distance: more goes round a dart
constexpr double kSameFold = 0.5;   // of an edge, between the middles of pairs of one fold; shallower ones are none
constexpr double kMatching = 1.5;   // between the depths of a pleat's two folds and their distance, either way

/// Where the outline is mapped onto itself.
struct Fold {
  double middle = 0;  // along the outline [m]
  double depth = 0;   // [m]
  Vec3 at = Vec3::Zero(), way = Vec3::Zero();
  int pairs = 0;
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

}  // namespace

std::vector<Pleat> find_pleats(const std::vector<int>& loop, const Positions& x, const std::vector<SeamPair>& own,
                               const Vec3& normal, double edge_length) {
  const std::vector<Fold> folds = folds_of(Outline(loop, x), x, own, edge_length);
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

}  // namespace toile
