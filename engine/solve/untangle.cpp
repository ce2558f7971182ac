#include "engine/solve/untangle.h"

#include <cmath>

namespace toile {
namespace {

struct Accumulated {
  Vec3 move = Vec3::Zero();
  double weight = 0;
};

/// The edges of `pierce` that go through `pierced` ask for their moves.
void add_piercings(const Positions& x, const Triangle& pierce, const Triangle& pierced,
                   std::vector<Accumulated>& moves) {
  const Vec3 &p = x[pierced[0]], &q = x[pierced[1]], &r = x[pierced[2]];
  const Vec3 area = (q - p).cross(r - p);
  const double twice_area = area.norm();
  if (twice_area <= 0) return;
  const Vec3 n = area / twice_area;
  const Vec3 own = (x[pierce[1]] - x[pierce[0]]).cross(x[pierce[2]] - x[pierce[0]]);
  for (int k = 0; k < 3; ++k) {
    const int a = pierce[k], b = pierce[(k + 1) % 3], c = pierce[(k + 2) % 3];
    const double da = n.dot(x[a] - p), db = n.dot(x[b] - p);
    if ((da > 0) == (db > 0)) continue;
    const double s = da / (da - db);
    const Vec3 hit = (1 - s) * x[a] + s * x[b];
    const Vec3 weight(area.dot((r - q).cross(hit - q)), area.dot((p - r).cross(hit - r)),
                      area.dot((q - p).cross(hit - p)));
    if ((weight.array() < 0).any()) continue;
    const Vec3 w = weight / weight.sum();
    Vec3 line = own.cross(n);
    const double length = line.norm();
    const Vec3 edge = (x[b] - x[a]).normalized();
    if (length <= 0) continue;
    line /= length;
    Vec3 inward = x[c] - x[a];
    inward -= edge * edge.dot(inward);
    if (line.dot(inward) < 0) line = -line;
    const double slope = edge.dot(n);
    Vec3 move = std::abs(slope) > 0.05 ? Vec3(line - n * (edge.dot(line) / slope)) : line;
    move.normalize();
    const auto add = [&](int v, double share, double sign) {
      moves[v].move += sign * share * move;
      moves[v].weight += share;
    };
    add(a, 1 - s, 1);
    add(b, s, 1);
    for (int i = 0; i < 3; ++i) add(pierced[i], w[i], -1);
  }
}

}  // namespace

Positions untangling_moves(const Positions& x, const std::vector<Triangle>& triangles,
                           const std::vector<TrianglePair>& crossings, double step) {
  std::vector<Accumulated> moves(x.size());
  for (const TrianglePair& pair : crossings) {
    add_piercings(x, triangles[pair.a], triangles[pair.b], moves);
    add_piercings(x, triangles[pair.b], triangles[pair.a], moves);
  }
  Positions result(x.size(), Vec3::Zero());
  for (std::size_t v = 0; v < x.size(); ++v)
    if (moves[v].weight > 0) result[v] = moves[v].move * (0.5 * step / std::max(moves[v].weight, 0.5));
  return result;
}

}  // namespace toile
