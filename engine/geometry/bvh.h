#pragma once
// A bounding volume hierarchy over axis-aligned boxes: which primitives may touch this box, which one is nearest.
// Built once per topology, refitted as the primitives move.

#include "engine/geometry/box.h"
#include "engine/types.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace toile {

/// Balanced binary tree (median split of centroids along the longest axis, ties by index), at most four primitives a
/// leaf, nodes in preorder so that a query is one forward walk without a stack. Boxes are held in single precision
/// rounded outwards: a query may call back for a box up to 3e-7 (relative) away, and never misses one that touches.
/// Deterministic: the same boxes give the same tree and the same order of callbacks on any number of threads.
/// Concurrent queries are safe; queries beside refit() are not. Boxes must be finite with lower <= upper.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(std::span<const Box> boxes);

  /// Moves the primitives and keeps the tree: boxes.size() must equal size().
  void refit(std::span<const Box> boxes);

  int size() const { return static_cast<int>(leaf_boxes_.size()); }
  bool empty() const { return leaf_boxes_.empty(); }

  /// Calls visit(int primitive) for every primitive whose box touches `box`. Allocates nothing.
  template <typename Visit>
  void query(const Box& box, Visit&& visit) const;

  /// The primitive with the least squared_distance(int primitive) below `squared_limit`, or -1. `squared_distance`
  /// must be no less than that from `point` to the primitive's box. Equal distances: the first met. Allocates nothing.
  template <typename SquaredDistance>
  int nearest(const Vec3& point, double squared_limit, SquaredDistance&& squared_distance) const;

 private:
  struct FloatBox {
    std::array<float, 3> lower, upper;
  };
  struct Node {
    FloatBox box;
    int skip;   ///< the node after this subtree
    int first;  ///< first primitive in leaf order of a leaf, -1 of an inner node
  };
  static constexpr int kLeafSize = 4;

  static FloatBox outwards(const Box& box);
  static FloatBox merged(const FloatBox& a, const FloatBox& b);
  static bool overlap(const FloatBox& a, const FloatBox& b) {
    return a.lower[0] <= b.upper[0] && b.lower[0] <= a.upper[0] && a.lower[1] <= b.upper[1] &&
           b.lower[1] <= a.upper[1] && a.lower[2] <= b.upper[2] && b.lower[2] <= a.upper[2];
  }
  static double squared_distance_to(const FloatBox& box, const Vec3& point) {
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      const double outside = std::max({box.lower[k] - point[k], 0.0, point[k] - box.upper[k]});
      squared += outside * outside;
    }
    return squared;
  }
  int leaf_end(int first) const { return first + kLeafSize < size() ? first + kLeafSize : size(); }
  void fit_leaves(std::span<const Box> boxes);
  void fit_inner_nodes();

  std::vector<Node> nodes_;
  std::vector<int> primitives_;       ///< in leaf order
  std::vector<FloatBox> leaf_boxes_;  ///< in leaf order
};

template <typename Visit>
void Bvh::query(const Box& box, Visit&& visit) const {
  const FloatBox wanted = outwards(box);
  const int end = static_cast<int>(nodes_.size());
  for (int n = 0; n < end;) {
    const Node& node = nodes_[n];
    if (!overlap(node.box, wanted)) {
      n = node.skip;
      continue;
    }
    if (node.first >= 0) {
      const int last = leaf_end(node.first);
      for (int i = node.first; i < last; ++i) {
        if (overlap(leaf_boxes_[i], wanted)) visit(primitives_[i]);
      }
    }
    ++n;
  }
}

template <typename SquaredDistance>
int Bvh::nearest(const Vec3& point, double squared_limit, SquaredDistance&& squared_distance) const {
  if (empty()) return -1;
  struct Entry {
    int node;
    double squared;
  };
  // A balanced tree over 2^31 primitives is less than 64 deep, and each level leaves one sibling waiting.
  std::array<Entry, 64> waiting;
  int count = 0;
  waiting[count++] = {0, squared_distance_to(nodes_[0].box, point)};
  int best = -1;
  double best_squared = squared_limit;
  while (count > 0) {
    const Entry entry = waiting[--count];
    if (!(entry.squared < best_squared)) continue;
    const Node& node = nodes_[entry.node];
    if (node.first >= 0) {
      const int last = leaf_end(node.first);
      for (int i = node.first; i < last; ++i) {
        if (!(squared_distance_to(leaf_boxes_[i], point) < best_squared)) continue;
        const double squared = squared_distance(primitives_[i]);
        if (squared < best_squared) {
          best_squared = squared;
          best = primitives_[i];
        }
      }
      continue;
    }
    const int left = entry.node + 1, right = nodes_[left].skip;
    const Entry l{left, squared_distance_to(nodes_[left].box, point)};
    const Entry r{right, squared_distance_to(nodes_[right].box, point)};
    const bool left_first = l.squared <= r.squared;
    waiting[count++] = left_first ? r : l;
    waiting[count++] = left_first ? l : r;
  }
  return best;
}

}  // namespace toile
