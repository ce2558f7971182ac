#pragma once
// OpenVDB's mesh conversion behind plain structs, so that one .cpp compiles its headers.

#include "engine/types.h"

#include <array>
#include <vector>

namespace toile {

/// A leaf of an OpenVDB tree: 8³ voxels, z fastest (OpenVDB's order).
struct BandLeaf {
  static constexpr int kSide = 8, kVoxels = kSide * kSide * kSide;
  static constexpr int index(int i, int j, int k) { return (i * kSide + j) * kSide + k; }

  std::array<int, 3> first{};             ///< the leaf's lowest voxel: multiples of 8
  std::array<float, kVoxels> distance{};  ///< [m], unsigned
  std::array<int, kVoxels> triangle{};    ///< that it was measured to; -1: outside the band
};

/// Leaves of the voxels origin + voxel·(i, j, k) that lie within `half_width` voxels of the triangles, ordered by
/// place. openvdb::tools::meshToVolume: exact up to ¾ of a voxel, farther away it takes the triangles that a
/// neighbour's distance was measured to, so that a few percent of the distances are too large (bodies at 5 mm: up to
/// ¾ of a voxel). The same on any number of threads.
std::vector<BandLeaf> narrow_band(const Positions& vertices, const std::vector<Triangle>& triangles, const Vec3& origin,
                                  double voxel, double half_width);

}  // namespace toile
