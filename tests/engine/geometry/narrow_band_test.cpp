#include "engine/geometry/narrow_band.h"

#include "engine/geometry/distance.h"
#include "tests/engine/geometry/mesh_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile {
namespace {

constexpr double kVoxel = 0.005, kWidth = 3;
const Vec3 kOrigin(-0.21, -0.2, -0.19);

TriangleMesh two_spheres() {
  return samples::joined(samples::icosphere(4, 0.1), samples::icosphere(3, 0.05, Vec3(0.09, 0.03, 0.01)));
}

Vec3 place(const BandLeaf& leaf, int i, int j, int k) {
  return kOrigin + kVoxel * Vec3(leaf.first[0] + i, leaf.first[1] + j, leaf.first[2] + k);
}

double to_triangle(const TriangleMesh& mesh, int t, const Vec3& p) {
  const auto& [a, b, c] = mesh.triangles[t];
  return std::sqrt(point_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]).squared_distance);
}

template <typename Visit>
void for_each_voxel(const std::vector<BandLeaf>& leaves, Visit&& visit) {
  for (const BandLeaf& leaf : leaves) {
    for (int i = 0; i < BandLeaf::kSide; ++i) {
      for (int j = 0; j < BandLeaf::kSide; ++j) {
        for (int k = 0; k < BandLeaf::kSide; ++k) visit(leaf, BandLeaf::index(i, j, k), place(leaf, i, j, k));
      }
    }
  }
}

TEST(NarrowBand, DistancesAreThoseToTheirTrianglesAndExactNearTheSurface) {
  const TriangleMesh mesh = two_spheres();
  const std::vector<BandLeaf> leaves = narrow_band(mesh.vertices, mesh.triangles, kOrigin, kVoxel, kWidth);
  long near = 0, checked = 0;
  for_each_voxel(leaves, [&](const BandLeaf& leaf, int at, const Vec3& p) {
    if (leaf.triangle[at] < 0) return;
    ASSERT_NEAR(leaf.distance[at], to_triangle(mesh, leaf.triangle[at], p), 1e-8);
    EXPECT_LT(leaf.distance[at], kWidth * kVoxel);
    if (leaf.distance[at] > 0.75 * kVoxel || ++near % 20 != 0) return;
    ++checked;
    double exact = std::numeric_limits<double>::infinity();
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) exact = std::min(exact, to_triangle(mesh, t, p));
    EXPECT_NEAR(leaf.distance[at], exact, 1e-8);
  });
  EXPECT_GT(checked, 200);
}

TEST(NarrowBand, HoldsEveryVoxelNearTheSurface) {
  const TriangleMesh mesh = samples::icosphere(5, 0.1);
  long held = 0;
  for_each_voxel(narrow_band(mesh.vertices, mesh.triangles, kOrigin, kVoxel, kWidth),
                 [&](const BandLeaf& leaf, int at, const Vec3& p) {
                   if (leaf.triangle[at] >= 0 && std::abs(p.norm() - 0.1) < 2.4 * kVoxel) ++held;
                 });
  long expected = 0;
  for (int i = 0; i <= 84; ++i) {
    for (int j = 0; j <= 84; ++j) {
      for (int k = 0; k <= 84; ++k) {
        if (std::abs((kOrigin + kVoxel * Vec3(i, j, k)).norm() - 0.1) < 2.4 * kVoxel) ++expected;
      }
    }
  }
  EXPECT_EQ(held, expected);
}

TEST(NarrowBand, LeavesDoNotOverlapAndAreTheSameOnOneThreadAndOnMany) {
  const TriangleMesh mesh = two_spheres();
  const auto band = [&](int threads) {
    return samples::on_threads(threads,
                               [&] { return narrow_band(mesh.vertices, mesh.triangles, kOrigin, kVoxel, kWidth); });
  };
  const std::vector<BandLeaf> one = band(1), two = band(2), four = band(4);
  for (const std::vector<BandLeaf>* many : {&two, &four}) {
    ASSERT_EQ(one.size(), many->size());
    for (size_t n = 0; n < one.size(); ++n) {
      EXPECT_EQ(one[n].first, (*many)[n].first);
      EXPECT_EQ(one[n].triangle, (*many)[n].triangle);
      EXPECT_EQ(one[n].distance, (*many)[n].distance);
    }
  }
  std::vector<std::array<int, 3>> places;
  for (const BandLeaf& leaf : one) places.push_back(leaf.first);
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
}

}  // namespace
}  // namespace toile
