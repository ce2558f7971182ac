#include "engine/solve/position_based.h"

#include "engine/geometry/mean.h"
#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile {
namespace {

constexpr double kCutting =
    -4e-3;  // [m] a seam whose middle is deeper inside the body than this would cut through a limb

/// Panels travel far, so the list reaches far; but not so far that a flat sheet of good triangles finds itself in it.
double list_radius(const Cloth& cloth) {
  double radius = 12e-3;
  for (const ClothPanel& panel : cloth.panels)
    if (panel.edge_length > 0) radius = std::min(radius, 0.8 * panel.edge_length);
  return radius;
}

}  // namespace

PositionBased::PositionBased(const Cloth& cloth, CollisionMesh mesh, std::vector<const BodyField*> body_of_vertex)
    : mobility(cloth.x.size(), 1.0),
      keep_height(cloth.x.size(), 0),
      nudge(cloth.x.size(), Vec3::Zero()),
      proximity_(std::move(mesh), list_radius(cloth)),
      body_(std::move(body_of_vertex)),
      body_samples_(cloth.x.size()),
      floor_(cloth.x.size()) {
  for (std::size_t v = 0; v < cloth.x.size(); ++v) floor_[v] = cloth.x[v].y();
  struct Side {
    int opposite;
    Vec2 from, to, tip;  // flat, with from belonging to the smaller vertex
  };
  std::map<std::array<int, 2>, std::vector<Side>> sides;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      int i = k, j = (k + 1) % 3;
      if (cloth.triangles[t][i] > cloth.triangles[t][j]) std::swap(i, j);
      const int o = (k + 2) % 3;
      sides[{cloth.triangles[t][i], cloth.triangles[t][j]}].push_back(
          {cloth.triangles[t][o], cloth.flat[t][i], cloth.flat[t][j], cloth.flat[t][o]});
    }
  for (const auto& [edge, around] : sides) {
    double rest = 0;
    for (const Side& side : around) rest += (side.to - side.from).norm() / static_cast<double>(around.size());
    stretch_.push_back({edge[0], edge[1], rest});
    if (around.size() != 2) continue;
    // The two tips as far apart as they are when both triangles lie flat on either side of the edge.
    const auto local = [](const Side& side) {
      const Vec2 axis = (side.to - side.from).normalized(), arm = side.tip - side.from;
      return Vec2(axis.dot(arm), std::abs(axis.x() * arm.y() - axis.y() * arm.x()));
    };
    const Vec2 p = local(around[0]), q = local(around[1]);
    bends_.push_back({around[0].opposite, around[1].opposite, std::hypot(p.x() - q.x(), p.y() + q.y())});
  }
}

void PositionBased::project(Positions& x, const Length& c, double share) const {
  const double wa = mobility[c.a], wb = mobility[c.b];
  if (wa + wb == 0) return;
  const Vec3 d = x[c.b] - x[c.a];
  const double length = d.norm();
  if (length < 1e-12) return;
  const Vec3 correction = d * (share * (length - c.rest) / (length * (wa + wb)));
  x[c.a] += wa * correction;
  x[c.b] -= wb * correction;
}

void PositionBased::set_pulls(const std::vector<SeamPull>& pulls) {
  pulls_ = pulls;
  std::map<int, int> set_of;  // vertex → index of its set; sets that meet are poured together
  std::vector<std::vector<int>> sets;
  const auto find = [&](int v) {
    const auto [at, fresh] = set_of.try_emplace(v, static_cast<int>(sets.size()));
    if (fresh) sets.push_back({v});
    return at->second;
  };
  for (const SeamPull& pull : pulls) {
    const int into = find(pull.a), from = find(pull.b);
    if (into == from) continue;
    for (int v : sets[from]) set_of[v] = into;
    sets[into].insert(sets[into].end(), sets[from].begin(), sets[from].end());
    sets[from].clear();
  }
  meeting_.clear();
  for (std::vector<int>& set : sets)
    if (set.size() > 1) meeting_.push_back(std::move(set));
}

Vec3 PositionBased::meeting_point(const std::vector<int>& vertices, const Positions& x) const {
  const auto held = std::find_if(vertices.begin(), vertices.end(), [&](int v) { return mobility[v] == 0; });
  return held != vertices.end() ? x[*held] : mean_of(x, vertices);
}

void PositionBased::limit_moves(const Positions& x, Positions& to) {
  proximity_.update(x);
  proximity_.limit_moves(x, to);
}

double PositionBased::step(Positions& x, const PositionBasedOptions& options) {
  const int n = static_cast<int>(x.size());
  const Positions start = x;
  proximity_.update(start);
  contacts_ = proximity_.contacts();
  if (carried_.size() != x.size()) carried_.assign(n, Vec3::Zero());
  pressed_.assign(n, 0.0);

  const double limit = options.max_move;
  for (int v = 0; v < n; ++v) {
    if (mobility[v] == 0) continue;
    Vec3 move = options.carry * carried_[v] + options.fall + nudge[v];
    const double length = move.norm();
    if (length > limit) move *= limit / length;
    x[v] += move;
  }
  parallel_for_each(n, 256, [&](int v) {
    if (body_[v]) body_samples_[v] = body_[v]->sample(start[v]);
  });
  std::vector<double> allowed(meeting_.size(), 0.0);  // distance from the mean
  std::vector<char> cutting(meeting_.size(), 0);
  for (std::size_t i = 0; i < meeting_.size(); ++i) {
    const Vec3 mean = meeting_point(meeting_[i], start);
    for (int v : meeting_[i]) allowed[i] = std::max(allowed[i], (start[v] - mean).norm() - 0.5 * options.closing);
    const BodyField* body = body_[meeting_[i].front()];
    cutting[i] = body && body->distance(mean) < kCutting;
  }

  const auto draw = [&](bool last) {
    for (std::size_t i = 0; i < meeting_.size(); ++i) {
      if (last && cutting[i]) continue;
      const Vec3 mean = meeting_point(meeting_[i], x);
      for (int v : meeting_[i]) {
        const Vec3 arm = x[v] - mean;
        const double length = arm.norm();
        if (mobility[v] > 0 && length > allowed[i]) x[v] = mean + arm * (allowed[i] / length);
      }
    }
  };

  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for (const Length& c : bends_) project(x, c, options.bending);
    for (const Length& c : stretch_) project(x, c, 1.0);
    draw(false);
    for (const Contact& c : contacts_) {
      Vec3 p = Vec3::Zero();
      double weight = 0;
      for (int k = 0; k < c.count; ++k) {
        p += c.weights[k] * x[c.nodes[k]];
        weight += c.weights[k] * c.weights[k] * mobility[c.nodes[k]];
      }
      const double lack = c.distance - (c.normal.dot(p) - c.offset);
      if (lack <= 0 || weight == 0) continue;
      for (int k = 0; k < c.count; ++k)
        x[c.nodes[k]] += c.normal * (mobility[c.nodes[k]] * c.weights[k] * lack / weight);
    }
    for (int v = 0; v < n; ++v) {
      if (!body_[v] || mobility[v] == 0) continue;
      const BodyField::Sample& s = body_samples_[v];
      const double lack = options.body_offset - (s.distance + s.normal.dot(x[v] - start[v]));
      if (lack <= 0) continue;
      const double push = std::min(lack, limit);
      x[v] += s.normal * push;
      if (options.body_friction <= 0) continue;
      // As much as the body has pushed in this step times the coefficient may be held back (Macklin et al. 2014, §6.1).
      pressed_[v] += push;
      const Vec3 move = x[v] - start[v], slip = move - s.normal.dot(move) * s.normal;
      const double length = slip.norm(), held = options.body_friction * pressed_[v];
      x[v] -= length > held ? Vec3(held / length * slip) : slip;
    }
    for (int v = 0; v < n; ++v)
      if (keep_height[v]) x[v].y() = std::max(x[v].y(), floor_[v]);
    // Last, since a seam has to close even in an armpit narrower than the offset; but not where it would cut into an
    // arm.
    draw(true);
  }

  largest_move_ = 0;
  for (int v = 0; v < n; ++v) {
    Vec3 move = x[v] - start[v];
    const double length = move.norm();
    if (length > 2 * limit) x[v] = start[v] + move * (2 * limit / length);
  }
  if (options.slide)
    proximity_.limit_moves(start, x);
  else
    limit_displacements(start, proximity_.displacement_bounds(), x);
  for (int v = 0; v < n; ++v) {
    carried_[v] = x[v] - start[v];
    largest_move_ = std::max(largest_move_, carried_[v].norm());
  }
  double gap = 0;
  for (const SeamPull& pull : pulls_) gap = std::max(gap, (x[pull.b] - x[pull.a]).norm());
  return gap;
}

}  // namespace toile
