#pragma once
// The exact outline of a panel: its edge curves, their lengths, points along them, area, and the panel's place in the
// world. Everything in metres. Semantics: shared/garmentcode-format.md, "Edge curvature" and "Right side of the
// fabric". Pure functions; thread-safe. Edge and vertex indices must be valid (scene/check.h tells).

#include "engine/scene/pattern.h"
#include "engine/types.h"

#include <vector>

namespace toile {

/// The edge's curve at `parameter` in [0, 1] (the curve's own parameter, not arc length).
Vec2 edge_point(const Panel& panel, int edge, double parameter);

/// Arc length [m]; closed form for lines and arcs, adaptive Gauss quadrature to 1e-10 relative for Béziers.
double edge_length(const Panel& panel, int edge);
inline constexpr double kShortestEdge = 2e-5;  ///< [m]; a shorter one is a point drawn twice

/// `segments` + 1 points from start to end, uniform in arc length; the first and last are the panel's own vertices.
std::vector<Vec2> sample_edge(const Panel& panel, int edge, int segments);

/// Area enclosed by the exact curves [m²], positive for a counter-clockwise loop (Green's theorem; exact).
double signed_area(const Panel& panel);

/// Unit normal of the fabric's right side in the world: rotation · (0, 0, ±1), + for a counter-clockwise loop.
Vec3 outward_normal(const Panel& panel);

/// Panel frame to world: rotation · (x, y, 0) + translation.
inline Vec3 to_world(const Panel& panel, const Vec2& point) {
  return panel.rotation * Vec3(point.x(), point.y(), 0) + panel.translation;
}

}  // namespace toile
