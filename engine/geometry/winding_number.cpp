#include "engine/geometry/winding_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {

namespace {

constexpr int kLeafSize = 8;

/// tan(Ω/2) = det(a, b, c) / (abc + (a·b) c + (b·c) a + (c·a) b) with the corners relative to the point.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

WindingNumber::WindingNumber(const Positions& vertices, const std::vector<Triangle>& triangles) {
  const int n = static_cast<int>(triangles.size());
  std::vector<int> order(n);
  corners_.resize(n);
  for (int i = 0; i < n; ++i) {
    order[i] = i;
    for (int k = 0; k < 3; ++k) corners_[i][k] = vertices[triangles[i][k]];
  }
  if (n > 0) build(order, 0, n);
  std::vector<std::array<Vec3, 3>> sorted(n);
  for (int i = 0; i < n; ++i) sorted[i] = corners_[order[i]];
  corners_ = std::move(sorted);
}

void WindingNumber::build(std::vector<int>& order, int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Box box;
  Vec3 weighted = Vec3::Zero(), area = Vec3::Zero();
  double total = 0;
  for (int i = begin; i < end; ++i) {
    const auto& [a, b, c] = corners_[order[i]];
    const Vec3 normal = 0.5 * (b - a).cross(c - a), middle = (a + b + c) / 3;
    const double size = normal.norm();
    area += normal;
    weighted += size * middle;
    total += size;
    box.extend(middle);
  }
  const Vec3 center = total > 0 ? Vec3(weighted / total) : Vec3(0.5 * (box.lower + box.upper));
  double radius2 = 0;
  for (int i = begin; i < end; ++i) {
    for (const Vec3& corner : corners_[order[i]]) radius2 = std::max(radius2, (corner - center).squaredNorm());
  }
  const bool leaf = end - begin <= kLeafSize;
  if (!leaf) {
    int axis;
    (box.upper - box.lower).maxCoeff(&axis);
    const auto middle_of = [&](int t) { return corners_[t][0][axis] + corners_[t][1][axis] + corners_[t][2][axis]; };
    const int middle = (begin + end) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
      const double x = middle_of(a), y = middle_of(b);
      return x < y || (x == y && a < b);
    });
    build(order, begin, middle);
    build(order, middle, end);
  }
  nodes_[index] = {center,         area, kFar * kFar * radius2, static_cast<int>(nodes_.size()), leaf ? begin : -1,
                   leaf ? end : -1};
}

double WindingNumber::operator()(const Vec3& q) const {
  double angle = 0;
  const int end = static_cast<int>(nodes_.size());
  for (int n = 0; n < end;) {
    const Node& node = nodes_[n];
    const Vec3 to = node.center - q;
    const double squared = to.squaredNorm();
    if (squared > node.far2 && squared > 0) {
      angle += node.area.dot(to) / (squared * std::sqrt(squared));
      n = node.skip;
      continue;
    }
    for (int i = node.first; i < node.last; ++i) {
      angle += solid_angle(corners_[i][0] - q, corners_[i][1] - q, corners_[i][2] - q);
    }
    ++n;
  }
  return angle / (4 * std::numbers::pi);
}

}  // namespace toile
