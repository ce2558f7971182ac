#pragma once
// Lengths, areas and normals of a pattern as read, by dense sampling: shares no code with the mesher.

#include "engine/scene/pattern.h"

#include <cmath>
#include <vector>

namespace toile::testing {

inline Vec2 on_edge(const Panel& panel, const PatternEdge& edge, double t) {
  const Vec2 s = panel.vertices[edge.start], e = panel.vertices[edge.end], d = e - s, n(-d.y(), d.x());
  const double r = 1 - t;
  const auto control = [&](const Vec2& c) -> Vec2 { return s + c.x() * d + c.y() * n; };
  if (const auto* q = std::get_if<QuadraticEdge>(&edge.curve)) {
    return r * r * s + 2 * r * t * control(q->control) + t * t * e;
  }
  if (const auto* c = std::get_if<CubicEdge>(&edge.curve)) {
    return r * r * r * s + 3 * r * r * t * control(c->control_start) + 3 * r * t * t * control(c->control_end) +
           t * t * t * e;
  }
  if (const auto* a = std::get_if<ArcEdge>(&edge.curve)) {
    const double half = d.norm() / 2, radius = std::max(a->radius, half);
    const double side = a->right != a->large_arc ? 1 : -1;
    const Vec2 centre = (s + e) / 2 + side * std::sqrt(radius * radius - half * half) * n.normalized();
    double sweep = 2 * std::asin(half / radius);
    if (a->large_arc) sweep = 2 * M_PI - sweep;
    return centre + Eigen::Rotation2Dd((a->right ? 1 : -1) * sweep * t) * (s - centre);
  }
  return s + t * d;
}

inline constexpr int kSamples = 4000;

inline double length(const Panel& panel, int edge) {
  double sum = 0;
  for (int k = 0; k < kSamples; ++k) {
    sum += (on_edge(panel, panel.edges[edge], (k + 1.0) / kSamples) -
            on_edge(panel, panel.edges[edge], double(k) / kSamples))
               .norm();
  }
  return sum;
}

/// Positive for a counter-clockwise loop.
inline double signed_area(const Panel& panel) {
  double twice = 0;
  for (const PatternEdge& edge : panel.edges) {
    for (int k = 0; k < kSamples; ++k) {
      const Vec2 p = on_edge(panel, edge, double(k) / kSamples), q = on_edge(panel, edge, (k + 1.0) / kSamples);
      twice += p.x() * q.y() - p.y() * q.x();
    }
  }
  return twice / 2;
}

inline Vec3 placed(const Panel& panel, const Vec2& p) {
  return panel.rotation * Vec3(p.x(), p.y(), 0) + panel.translation;
}

inline Vec3 outward_normal(const Panel& panel) { return panel.rotation * Vec3(0, 0, signed_area(panel) > 0 ? 1 : -1); }

}  // namespace toile::testing
