#include "engine/geometry/bvh.h"

#include "engine/parallel/parallel_for.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cassert>
#include <cfloat>
#include <cmath>
#include <functional>

namespace toile {

namespace {

struct Centroid {
  std::array<float, 3> at;
  int primitive;
};

/// Splits [begin, end) of the centroids in two leaf-aligned halves along the longest axis of their extent.
Centroid* split(Centroid* begin, Centroid* middle, Centroid* end) {
  std::array<float, 3> low{FLT_MAX, FLT_MAX, FLT_MAX}, high{-FLT_MAX, -FLT_MAX, -FLT_MAX};
  for (const Centroid* c = begin; c != end; ++c) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], c->at[k]);
      high[k] = std::max(high[k], c->at[k]);
    }
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  std::nth_element(begin, middle, end, [axis](const Centroid& a, const Centroid& b) {
    return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.primitive < b.primitive);
  });
  return middle;
}

/// One ulp or more beyond the nearest float, so that the double lies on the right side of it.
float below(double x) {
  const float f = static_cast<float>(x);
  return f - (std::abs(f) * 0x1p-23f + FLT_MIN);
}
float above(double x) {
  const float f = static_cast<float>(x);
  return f + (std::abs(f) * 0x1p-23f + FLT_MIN);
}

}  // namespace

Bvh::FloatBox Bvh::outwards(const Box& box) {
  return {{below(box.lower.x()), below(box.lower.y()), below(box.lower.z())},
          {above(box.upper.x()), above(box.upper.y()), above(box.upper.z())}};
}

Bvh::FloatBox Bvh::merged(const FloatBox& a, const FloatBox& b) {
  FloatBox m;
  for (int k = 0; k < 3; ++k) {
    m.lower[k] = std::min(a.lower[k], b.lower[k]);
    m.upper[k] = std::max(a.upper[k], b.upper[k]);
  }
  return m;
}

Bvh::Bvh(std::span<const Box> boxes) {
  const int n = static_cast<int>(boxes.size());
  if (n == 0) return;
  std::vector<Centroid> centroids(n);
  for (int i = 0; i < n; ++i) {
    const Vec3 c = 0.5 * (boxes[i].lower + boxes[i].upper);
    assert(c.allFinite());
    centroids[i] = {{static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())}, i};
  }
  const auto leaves = [](int count) { return (count + kLeafSize - 1) / kLeafSize; };
  nodes_.resize(2 * leaves(n) - 1);
  // A subtree over c primitives has 2·leaves(c) − 1 nodes whatever their places, so both halves can be built at once.
  const std::function<void(int, int, int)> build = [&](int node, int begin, int end) {
    const int total = leaves(end - begin);
    nodes_[node].skip = node + 2 * total - 1;
    nodes_[node].first = total == 1 ? begin : -1;
    if (total == 1) return;
    const int middle = begin + total / 2 * kLeafSize;
    split(centroids.data() + begin, centroids.data() + middle, centroids.data() + end);
    const auto left = [&] { build(node + 1, begin, middle); };
    const auto right = [&] { build(node + 2 * (total / 2), middle, end); };
    if (end - begin > 4096) {
      tbb::parallel_invoke(left, right);
    } else {
      left();
      right();
    }
  };
  build(0, 0, n);
  primitives_.resize(n);
  for (int i = 0; i < n; ++i) primitives_[i] = centroids[i].primitive;
  leaf_boxes_.resize(n);
  refit(boxes);
}

void Bvh::refit(std::span<const Box> boxes) {
  assert(static_cast<int>(boxes.size()) == size());
  fit_leaves(boxes);
  fit_inner_nodes();
}

void Bvh::fit_leaves(std::span<const Box> boxes) {
  parallel_ranges(static_cast<int>(nodes_.size()), 1024, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) {
      Node& node = nodes_[n];
      if (node.first < 0) continue;
      const int last = leaf_end(node.first);
      for (int i = node.first; i < last; ++i) leaf_boxes_[i] = outwards(boxes[primitives_[i]]);
      node.box = leaf_boxes_[node.first];
      for (int i = node.first + 1; i < last; ++i) node.box = merged(node.box, leaf_boxes_[i]);
    }
  });
}

void Bvh::fit_inner_nodes() {
  for (int n = static_cast<int>(nodes_.size()) - 1; n >= 0; --n) {
    Node& node = nodes_[n];
    if (node.first < 0) node.box = merged(nodes_[n + 1].box, nodes_[nodes_[n + 1].skip].box);
  }
}

}  // namespace toile
