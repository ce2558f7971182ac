#pragma once
// Axis-aligned boxes.

#include "engine/types.h"

#include <limits>

namespace toile {

/// Closed axis-aligned box [m]. Starts empty (lower > upper); extended() and merged() grow it.
struct Box {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return (lower.array() > upper.array()).any(); }
  void extend(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void extend(const Box& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  /// Grown by `margin` [m] on every side.
  Box inflated(double margin) const { return {lower.array() - margin, upper.array() + margin}; }
  bool contains(const Vec3& p) const {
    return (p.array() >= lower.array()).all() && (p.array() <= upper.array()).all();
  }
  bool touches(const Box& o) const {
    return (lower.array() <= o.upper.array()).all() && (o.lower.array() <= upper.array()).all();
  }
};

inline Box bounding_box(const Positions& points) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

inline Box triangle_box(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

}  // namespace toile
