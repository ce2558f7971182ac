#pragma once
// A signed distance sampled on two regular grids: OpenVDB's narrow band around the surface, a coarse grid everywhere
// else.

#include "engine/geometry/box.h"
#include "engine/geometry/narrow_band.h"
#include "engine/geometry/solid.h"
#include "engine/types.h"

#include <functional>
#include <vector>

namespace toile {

class Bvh;

/// Samples of a function on the nodes origin + spacing·(i, j, k); i runs fastest.
struct Lattice {
  Vec3 origin = Vec3::Zero();
  double spacing = 1;
  std::array<int, 3> nodes{};

  Vec3 point(int i, int j, int k) const { return origin + spacing * Vec3(i, j, k); }
  size_t index(int i, int j, int k) const { return (static_cast<size_t>(k) * nodes[1] + j) * nodes[0] + i; }
  size_t size() const { return static_cast<size_t>(nodes[0]) * nodes[1] * nodes[2]; }
};

/// A closed triangle soup that bounds a solid, and what is inside of it. Triangles carry the distance, `inside` the
/// sign.
struct SoupSolid {
  Positions vertices;
  std::vector<Triangle> triangles;
  std::function<bool(const Vec3&)> inside;  ///< safe to call from many threads
};

struct GridSettings {
  double fine_spacing = 0.005, coarse_spacing = 0.01;  ///< [m]
  double margin = 0.08;  ///< of the coarse grid around the solid [m], at least five fine cells
};

/// The fine grid is the narrow band that OpenVDB's mesh conversion finds (narrow_band.h): its leaves, its distances
/// made exact by a BVH search that they bound, its sign from SoupSolid::inside, asked only where no neighbour of the
/// same side is known. The coarse grid is as exact inside and within the margin; farther out it is interpolated from
/// every second or fourth node. Voxels of a leaf beyond the band continue it.
/// Values between nodes are trilinear. The gradient is the trilinear interpolation of the nodes' central differences:
/// unlike the gradient of the trilinear interpolant it is continuous within a grid, at 32 nodes read instead of 8.
/// Where the leaves end, it jumps by the coarse grid's error. Leaves are copied with the nodes around them, so that a
/// sample reads one contiguous block instead of walking OpenVDB's tree up to 32 times (tests/engine/geometry prints its
/// cost). Immutable; concurrent calls are safe. Deterministic on any number of threads.
class DistanceGrid {
 public:
  DistanceGrid(const SoupSolid& solid, const GridSettings& settings);

  double distance(const Vec3& point) const;
  FieldSample sample(const Vec3& point) const;

  const GridSettings& settings() const { return settings_; }
  const Lattice& coarse() const { return coarse_; }
  float coarse_value(size_t index) const { return coarse_values_[index]; }
  size_t bytes() const { return sizeof(float) * (coarse_values_.size() + brick_values_.size()); }

 private:
  /// The cell of a point: its stencil's first node (one before the cell), strides, and the place within the cell.
  struct Cell {
    const float* first;
    int stride_y, stride_z;
    Vec3 at;
    double spacing;
  };
  static constexpr int kBrick = BandLeaf::kSide;  ///< cells along a brick's edge: a brick holds a leaf
  static constexpr int kBrickNodes = kBrick + 3;  ///< with the nodes that the stencils of its outermost cells read

  void fill_coarse(const Bvh& bvh, const SoupSolid& solid);
  /// Of the nodes `stride` away along each axis that lies between nodes of twice the stride.
  float mean_around(const std::array<int, 3>& node, int stride) const;
  void fill_bricks(const std::vector<BandLeaf>& leaves);
  float fine_value(const std::vector<BandLeaf>& leaves, const std::array<int, 3>& node) const;
  /// Of a brick; -1 where there is none.
  int brick_at(const std::array<int, 3>& brick) const {
    return brick_index_[(static_cast<size_t>(brick[2]) * bricks_[1] + brick[1]) * bricks_[0] + brick[0]];
  }
  Cell cell_at(const Vec3& point) const;
  Cell coarse_cell_at(const Vec3& point) const;
  static double trilinear(const Cell& cell);
  Vec3 into_coarse(const Vec3& point) const;

  GridSettings settings_;
  Lattice coarse_;
  std::vector<float> coarse_values_;
  std::array<int, 3> bricks_{};
  std::vector<int> brick_index_;  ///< -1: none
  std::vector<float> brick_values_;
};

}  // namespace toile
