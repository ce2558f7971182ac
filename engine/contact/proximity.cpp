#include "engine/contact/proximity.h"

#include "engine/geometry/distance.h"
#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_set>

namespace toile {
namespace {

constexpr int kBlock = 512;  // features per task; blocks are joined in order, so the lists don't depend on threads
constexpr double kBoundFraction = 0.45;     // of the nearest distance; below ½ with room for rounding
constexpr double kRoundOff = 1e-8;          // [m] of the distance is never used up, or rounding could cross it
constexpr double kRebuildFraction = 0.25;   // of the list radius, moved by any vertex
constexpr double kFeatureTolerance = 1e-9;  // a weight below this means that the closest point lies on a sub-feature

Box box_of(const Positions& x, const int* nodes, int count, double margin) {
  Box box{x[nodes[0]], x[nodes[0]]};
  for (int k = 1; k < count; ++k) {
    box.lower = box.lower.cwiseMin(x[nodes[k]]);
    box.upper = box.upper.cwiseMax(x[nodes[k]]);
  }
  box.lower.array() -= margin;
  box.upper.array() += margin;
  return box;
}

std::uint64_t mix(std::uint64_t h) {  // SplitMix64's finaliser
  h ^= h >> 30;
  h *= 0xbf58476d1ce4e5b9ULL;
  h ^= h >> 27;
  h *= 0x94d049bb133111ebULL;
  return h ^ (h >> 31);
}

std::uint64_t key_of(const Contact& contact) {
  std::array<int, 4> nodes{};
  int used = 0;
  std::uint64_t side = 0;
  for (int k = 0; k < contact.count; ++k) {
    if (std::abs(contact.weights[k]) <= kFeatureTolerance) continue;
    int at = used++;
    for (; at > 0 && nodes[at - 1] > contact.nodes[k]; --at) nodes[at] = nodes[at - 1];
    nodes[at] = contact.nodes[k];
    if (contact.weights[k] > 0) side += mix(static_cast<std::uint64_t>(contact.nodes[k]) + 1);
  }
  std::uint64_t h = mix(side + 0x9e3779b97f4a7c15ULL);
  for (int k = 0; k < used; ++k) h = mix(h ^ (static_cast<std::uint64_t>(nodes[k]) + 0x9e3779b97f4a7c15ULL * (k + 1)));
  return h;
}

constexpr int kSweeps = 4;  // of taking off a move what goes against planes, before it is scaled

}  // namespace

Proximity::Proximity(CollisionMesh mesh, double list_radius) : mesh_(std::move(mesh)) {
  double largest = 0;
  for (std::size_t v = 0; v < mesh_.fabric.size(); ++v)
    if (mesh_.wanted_distance[v] < 1.0)
      largest = std::max(largest, std::min(mesh_.wanted_distance[v], mesh_.distance_limit[v]));
  list_radius_ = std::max(list_radius, 2.5 * largest);
}

bool Proximity::belong_together(const int* a, int na, const int* b, int nb) const {
  for (int i = 0; i < na; ++i)
    for (int j = 0; j < nb; ++j)
      if (mesh_.identity[a[i]] == mesh_.identity[b[j]]) return true;
  if (mesh_.seam_zone.empty()) return false;
  const bool one_panel = !mesh_.panel.empty() && mesh_.panel[a[0]] == mesh_.panel[b[0]];
  for (int i = 0; i < na; ++i)
    for (int j = 0; j < nb; ++j) {
      const std::vector<int>&u = mesh_.seam_zone[a[i]], &v = mesh_.seam_zone[b[j]];
      for (auto p = u.begin(), q = v.begin(); p != u.end() && q != v.end();) {
        if (*p == *q && (*p < 0 || !one_panel)) return true;
        *p < *q ? ++p : ++q;
      }
    }
  return false;
}

std::array<int, 4> Proximity::nodes_of(int pair) const {
  const int vt = static_cast<int>(vertex_triangle_.size());
  if (pair < vt) {
    const auto& [v, t] = vertex_triangle_[pair];
    return {v, mesh_.triangles[t][0], mesh_.triangles[t][1], mesh_.triangles[t][2]};
  }
  const auto& [e, f] = edge_edge_[pair - vt];
  return {mesh_.edges[e][0], mesh_.edges[e][1], mesh_.edges[f][0], mesh_.edges[f][1]};
}

Proximity::Measured Proximity::measure(int pair, const Positions& x) const {
  Measured measured;
  Contact& c = measured.contact;
  c.count = 4;
  c.between_layers = true;
  c.nodes = nodes_of(pair);
  const auto& [a, b, d, e] = c.nodes;
  if (pair < static_cast<int>(vertex_triangle_.size())) {
    const auto closest = point_triangle(x[a], x[b], x[d], x[e]);
    c.weights = {1, -closest.weights[0], -closest.weights[1], -closest.weights[2]};
  } else {
    measured.first_side = 2;
    const auto closest = segment_segment(x[a], x[b], x[d], x[e]);
    c.weights = {1 - closest.s, closest.s, closest.t - 1, -closest.t};
  }
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 4; ++k) p += c.weights[k] * x[c.nodes[k]];
  measured.distance = p.norm();
  if (measured.distance > 0) c.normal = p / measured.distance;
  c.anchor = p;
  return measured;
}

void Proximity::rebuild_list(const Positions& x) {
  const int triangles = static_cast<int>(mesh_.triangles.size()), edges = static_cast<int>(mesh_.edges.size());
  std::vector<Box> triangle_boxes(triangles), edge_boxes(edges);
  parallel_for_each(triangles, kBlock, [&](int t) { triangle_boxes[t] = box_of(x, mesh_.triangles[t].data(), 3, 0); });
  parallel_for_each(edges, kBlock, [&](int e) { edge_boxes[e] = box_of(x, mesh_.edges[e].data(), 2, 0); });
  if (listed_at_.empty()) {
    triangle_bvh_ = Bvh(triangle_boxes);
    edge_bvh_ = Bvh(edge_boxes);
  } else {
    triangle_bvh_.refit(triangle_boxes);
    edge_bvh_.refit(edge_boxes);
  }
  listed_at_ = x;

  const auto collect = [&](int count, auto&& pairs_of) {
    const int blocks = (count + kBlock - 1) / kBlock;
    std::vector<std::vector<Pair>> found(blocks);
    parallel_for_each(blocks, 1, [&](int block) {
      const int end = std::min(count, (block + 1) * kBlock);
      for (int i = block * kBlock; i < end; ++i) pairs_of(i, found[block]);
    });
    std::vector<Pair> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  const double radius2 = list_radius_ * list_radius_;
  vertex_triangle_ = collect(static_cast<int>(x.size()), [&](int v, std::vector<Pair>& out) {
    triangle_bvh_.query(box_of(x, &v, 1, list_radius_), [&](int t) {
      const Triangle& tri = mesh_.triangles[t];
      if (belong_together(&v, 1, tri.data(), 3)) return;
      if (point_triangle(x[v], x[tri[0]], x[tri[1]], x[tri[2]]).squared_distance < radius2) out.push_back({v, t});
    });
  });
  edge_edge_ = collect(edges, [&](int e, std::vector<Pair>& out) {
    const auto& first = mesh_.edges[e];
    edge_bvh_.query(box_of(x, first.data(), 2, list_radius_), [&](int f) {
      if (f <= e) return;
      const auto& second = mesh_.edges[f];
      if (belong_together(first.data(), 2, second.data(), 2)) return;
      if (segment_segment(x[first[0]], x[first[1]], x[second[0]], x[second[1]]).squared_distance < radius2)
        out.push_back({e, f});
    });
  });
}

void Proximity::update(const Positions& x) {
  double moved2 = std::numeric_limits<double>::infinity();
  if (listed_at_.size() == x.size()) {
    moved2 = 0;
    for (std::size_t v = 0; v < x.size(); ++v) moved2 = std::max(moved2, (x[v] - listed_at_[v]).squaredNorm());
  }
  if (!(moved2 <= std::pow(kRebuildFraction * list_radius_, 2))) {
    rebuild_list(x);
    moved2 = 0;
  }
  // Whatever is not listed was farther than the radius when the list was made.
  unlisted_ = list_radius_ - 2 * std::sqrt(moved2);

  const int vt = static_cast<int>(vertex_triangle_.size()), total = vt + static_cast<int>(edge_edge_.size());
  std::vector<Measured> measured(total);
  parallel_ranges(total, kBlock, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      measured[i] = measure(i, x);
      Contact& c = measured[i].contact;
      const std::span<const int> nodes(c.nodes), first = nodes.first(measured[i].first_side),
                                                 second = nodes.subspan(measured[i].first_side);
      c.distance = mesh_.pair_distance(first, second);
      c.friction = mesh_.pair_friction(first, second);
    }
  });

  bounds_.assign(x.size(), unlisted_);
  smallest_distance_ = unlisted_;
  contacts_.clear();
  std::unordered_set<std::uint64_t> seen;
  for (int i = 0; i < total; ++i) {
    Contact& c = measured[i].contact;
    const double d = measured[i].distance;
    for (int k = 0; k < 4; ++k) bounds_[c.nodes[k]] = std::min(bounds_[c.nodes[k]], d);
    smallest_distance_ = std::min(smallest_distance_, d);
    if (d >= c.distance || d <= 0) continue;
    // An edge pair whose nearest points include an end is a vertex–triangle pair too.
    const bool interior = i < vt || (c.weights[0] > kFeatureTolerance && c.weights[1] > kFeatureTolerance &&
                                     -c.weights[2] > kFeatureTolerance && -c.weights[3] > kFeatureTolerance);
    if (!interior) continue;
    c.key = key_of(c);
    if (seen.insert(c.key).second) contacts_.push_back(c);
  }
  for (double& bound : bounds_) bound = kBoundFraction * std::max(0.0, bound - kRoundOff);
}

long Proximity::limit_moves(const Positions& x, Positions& to) const {
  std::vector<char> beyond(x.size(), 0);  // its bound: whatever stays within can't cross anything
  bool any = false;
  for (std::size_t v = 0; v < x.size(); ++v) {
    beyond[v] = (to[v] - x[v]).norm() > bounds_[v];
    any = any || beyond[v];
  }
  if (!any) return 0;

  struct HalfSpace {
    int vertex;
    Vec3 inward;
    double slack;  // that may be used up against it [m]
  };
  const double free = kBoundFraction * std::max(0.0, unlisted_ - kRoundOff);
  std::vector<HalfSpace> found;
  std::vector<char> stuck(x.size(), 0);
  const int total = static_cast<int>(vertex_triangle_.size() + edge_edge_.size());
  for (int i = 0; i < total; ++i) {
    const std::array<int, 4> nodes = nodes_of(i);
    if (std::none_of(nodes.begin(), nodes.end(), [&](int v) { return beyond[v] != 0; })) continue;
    const Measured pair = measure(i, x);
    const Vec3& normal = pair.contact.normal;
    // The nearest points of convex features: each feature lies wholly behind its own.
    Vec3 nearest = Vec3::Zero();
    for (int k = 0; k < pair.first_side; ++k) nearest += pair.contact.weights[k] * x[nodes[k]];
    const double offset = normal.dot(nearest) - 0.5 * pair.distance;
    for (int k = 0; k < 4; ++k) {
      if (!beyond[nodes[k]]) continue;
      if (pair.distance <= 0) stuck[nodes[k]] = 1;  // no plane lies between what touches
      const double height = std::abs(normal.dot(x[nodes[k]]) - offset);
      const double slack = 2 * kBoundFraction * std::max(0.0, height - 0.5 * kRoundOff);
      if (slack < free) found.push_back({nodes[k], k < pair.first_side ? normal : Vec3(-normal), slack});
    }
  }
  std::vector<int> first(x.size() + 1, 0);
  for (const HalfSpace& limit : found) ++first[limit.vertex + 1];
  for (std::size_t v = 0; v < x.size(); ++v) first[v + 1] += first[v];
  std::vector<HalfSpace> half_spaces(found.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (const HalfSpace& limit : found) half_spaces[next[limit.vertex]++] = limit;

  std::vector<char> shortened(x.size(), 0);
  parallel_ranges(static_cast<int>(x.size()), kBlock, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      if (!beyond[v]) continue;
      const std::span<const HalfSpace> limits(half_spaces.data() + first[v], half_spaces.data() + first[v + 1]);
      Vec3 move = to[v] - x[v];
      const double length = move.norm();
      if (length > free) move *= free / length;
      for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const HalfSpace& limit : limits) {
          const double over = -limit.slack - limit.inward.dot(move);
          if (over > 0) move += over * limit.inward;
        }
      double share = stuck[v] ? 0 : 1;
      for (const HalfSpace& limit : limits) {
        const double towards = -limit.inward.dot(move);
        if (towards > limit.slack) share = std::min(share, limit.slack / towards);
      }
      shortened[v] = share < 1 || move != to[v] - x[v];
      if (shortened[v]) to[v] = x[v] + share * move;
    }
  });
  return std::count(shortened.begin(), shortened.end(), 1);
}

long limit_displacements(const Positions& from, const std::vector<double>& bounds, Positions& x) {
  long limited = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vec3 move = x[v] - from[v];
    const double length = move.norm();
    if (length <= bounds[v]) continue;
    x[v] = from[v] + move * (bounds[v] / length);
    ++limited;
  }
  return limited;
}

}  // namespace toile
