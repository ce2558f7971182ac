#include "engine/geometry/distance_grid.h"

#include "engine/geometry/bvh.h"
#include "engine/geometry/distance.h"
#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace toile {

namespace {

/// Half the width of the fine band in fine cells: what the stencil of a cell that the surface crosses reads, and more.
constexpr double kBand = 4.0;
/// The coarse grid is refined from every fourth node on. Exterior nodes so many strides beyond the margin take the mean
/// of those around them: √3 strides away, so that no cell within the margin reads them.
constexpr int kFirstStride = 4;
constexpr double kBeyondMargin = 2;

/// Exact signed distances along lines of nodes: the last answer bounds the next search, and the sign is asked for again
/// only where the surface is near enough to have been crossed.
class Walker {
 public:
  Walker(const Bvh& bvh, const SoupSolid& solid) : bvh_(bvh), solid_(solid) {}

  /// `hint`: a triangle that is thought near, or -1.
  double signed_distance(const Vec3& p, int hint = -1) {
    if (hint >= 0) triangle_ = hint;
    const double limit = triangle_ < 0 ? std::numeric_limits<double>::infinity() : squared(triangle_, p);
    const int nearer = bvh_.nearest(p, limit, [&](int t) { return squared(t, p); });
    const double distance = std::sqrt(nearer < 0 ? limit : squared(nearer, p));
    if (nearer >= 0) triangle_ = nearer;
    const double step = (p - last_point_).norm();
    // A ball around either point that reaches the other one holds no surface: both lie on the same side.
    const bool same_side = known_ && step < std::max(distance, std::abs(last_distance_));
    const bool inside = same_side ? last_distance_ < 0 : is_inside(p);
    known_ = true;
    last_point_ = p;
    last_distance_ = inside ? -distance : distance;
    return last_distance_;
  }

 private:
  double squared(int t, const Vec3& p) const {
    const auto& [a, b, c] = solid_.triangles[t];
    return point_triangle(p, solid_.vertices[a], solid_.vertices[b], solid_.vertices[c]).squared_distance;
  }

  bool is_inside(const Vec3& p) const {
    const auto& [i, j, k] = solid_.triangles[triangle_];
    const Vec3 &a = solid_.vertices[i], &b = solid_.vertices[j], &c = solid_.vertices[k];
    const Vec3 weights = point_triangle(p, a, b, c).weights;
    // Nothing lies between a point and the surface nearest to it: within a face, its side decides. At edges and corners
    // it does not, nor for pieces so thin that their normal is noise.
    const Vec3 normal = (b - a).cross(c - a);
    const double side = normal.dot(p - a);
    const double size2 = std::max((b - a).squaredNorm(), (c - a).squaredNorm());
    if (weights.minCoeff() < kWithinFace || normal.norm() < kWithinFace * size2 ||
        std::abs(side) < kWithinFace * normal.norm() * std::sqrt(size2)) {
      return solid_.inside(p);
    }
    return side < 0;
  }

  static constexpr double kWithinFace = 1e-3;  ///< relative

  const Bvh& bvh_;
  const SoupSolid& solid_;
  int triangle_ = -1;
  bool known_ = false;
  Vec3 last_point_ = Vec3::Zero();
  double last_distance_ = 0;
};

Bvh triangle_bvh(const SoupSolid& solid) {
  std::vector<Box> boxes;
  boxes.reserve(solid.triangles.size());
  for (const auto& [a, b, c] : solid.triangles) {
    boxes.push_back(triangle_box(solid.vertices[a], solid.vertices[b], solid.vertices[c]));
  }
  return Bvh(boxes);
}

/// 0 … n − 1, or back in every other line, so that each node is next to the one before it.
int to_and_fro(int i, int line, int n) { return line % 2 == 0 ? i : n - 1 - i; }

/// Takes the leaf's distances as bounds, and signs what it finds.
void make_exact(BandLeaf& leaf, const Vec3& origin, double voxel, Walker walker) {
  constexpr int n = BandLeaf::kSide;
  for (int i = 0; i < n; ++i) {
    for (int jj = 0; jj < n; ++jj) {
      const int j = to_and_fro(jj, i, n);
      for (int kk = 0; kk < n; ++kk) {
        const int k = to_and_fro(kk, i * n + jj, n), at = BandLeaf::index(i, j, k);
        if (leaf.triangle[at] < 0) continue;
        const Vec3 point = origin + voxel * Vec3(leaf.first[0] + i, leaf.first[1] + j, leaf.first[2] + k);
        leaf.distance[at] = static_cast<float>(walker.signed_distance(point, leaf.triangle[at]));
      }
    }
  }
}

double mix(double a, double b, double t) { return a + t * (b - a); }

}  // namespace

DistanceGrid::DistanceGrid(const SoupSolid& solid, const GridSettings& settings) : settings_(settings) {
  const Bvh bvh = triangle_bvh(solid);
  Box box;
  for (const Triangle& t : solid.triangles) {
    for (int v : t) box.extend(solid.vertices[v]);
  }
  box = box.inflated(settings.margin);
  // Bricks tile the coarse grid's box from its lower corner.
  const double brick_size = kBrick * settings.fine_spacing;
  coarse_.origin = box.lower;
  coarse_.spacing = settings.coarse_spacing;
  for (int k = 0; k < 3; ++k) {
    bricks_[k] = static_cast<int>(std::ceil((box.upper[k] - box.lower[k]) / brick_size));
    coarse_.nodes[k] =
        kFirstStride * static_cast<int>(std::ceil(bricks_[k] * brick_size / (kFirstStride * coarse_.spacing))) + 1;
  }
  fill_coarse(bvh, solid);
  std::vector<BandLeaf> leaves =
      narrow_band(solid.vertices, solid.triangles, coarse_.origin, settings.fine_spacing, kBand);
  parallel_for_each(static_cast<int>(leaves.size()), 1,
                    [&](int n) { make_exact(leaves[n], coarse_.origin, settings_.fine_spacing, Walker(bvh, solid)); });
  fill_bricks(leaves);
}

void DistanceGrid::fill_coarse(const Bvh& bvh, const SoupSolid& solid) {
  coarse_values_.resize(coarse_.size());
  for (int stride = kFirstStride; stride >= 1; stride /= 2) {
    const auto is_known = [&](int i, int j, int k) { return stride < kFirstStride && (i | j | k) % (2 * stride) == 0; };
    parallel_for_each((coarse_.nodes[2] - 1) / stride + 1, 1, [&](int layer) {
      Walker walker(bvh, solid);
      const int k = stride * layer, columns = (coarse_.nodes[0] - 1) / stride + 1;
      for (int j = 0; j < coarse_.nodes[1]; j += stride) {
        for (int column = 0; column < columns; ++column) {
          const int i = stride * to_and_fro(column, j / stride, columns);
          if (is_known(i, j, k)) continue;
          float& value = coarse_values_[coarse_.index(i, j, k)];
          if (stride < kFirstStride) {
            value = mean_around({i, j, k}, stride);
            if (value > settings_.margin + kBeyondMargin * stride * coarse_.spacing) continue;
          }
          value = static_cast<float>(walker.signed_distance(coarse_.point(i, j, k)));
        }
      }
    });
  }
}

float DistanceGrid::mean_around(const std::array<int, 3>& node, int stride) const {
  std::array<int, 3> reach;
  for (int k = 0; k < 3; ++k) reach[k] = node[k] % (2 * stride);
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    sum += coarse_values_[coarse_.index(node[0] + (corner & 1 ? reach[0] : -reach[0]),
                                        node[1] + (corner & 2 ? reach[1] : -reach[1]),
                                        node[2] + (corner & 4 ? reach[2] : -reach[2]))];
  }
  return sum / 8;
}

void DistanceGrid::fill_bricks(const std::vector<BandLeaf>& leaves) {
  assert(settings_.margin >= (kBand + 1) * settings_.fine_spacing);  // every leaf is within the bricks
  brick_index_.assign(static_cast<size_t>(bricks_[0]) * bricks_[1] * bricks_[2], -1);
  for (size_t n = 0; n < leaves.size(); ++n) {
    const auto& [i, j, k] = leaves[n].first;
    brick_index_[(static_cast<size_t>(k / kBrick) * bricks_[1] + j / kBrick) * bricks_[0] + i / kBrick] =
        static_cast<int>(n);
  }
  constexpr int kNodes = kBrickNodes * kBrickNodes * kBrickNodes;
  brick_values_.resize(leaves.size() * kNodes);
  parallel_for_each(static_cast<int>(leaves.size()), 1, [&](int n) {
    float* value = &brick_values_[static_cast<std::size_t>(n) * kNodes];
    const auto& first = leaves[n].first;
    for (int k = first[2] - 1; k < first[2] - 1 + kBrickNodes; ++k) {
      for (int j = first[1] - 1; j < first[1] - 1 + kBrickNodes; ++j) {
        for (int i = first[0] - 1; i < first[0] - 1 + kBrickNodes; ++i) {
          *value++ = fine_value(leaves, {i, j, k});
        }
      }
    }
  });
}

float DistanceGrid::fine_value(const std::vector<BandLeaf>& leaves, const std::array<int, 3>& node) const {
  std::array<int, 3> brick;
  bool within = true;
  for (int k = 0; k < 3; ++k) {
    brick[k] = node[k] / kBrick;
    within = within && node[k] >= 0 && brick[k] < bricks_[k];
  }
  if (const int n = within ? brick_at(brick) : -1; n >= 0) {
    const int at = BandLeaf::index(node[0] % kBrick, node[1] % kBrick, node[2] % kBrick);
    if (leaves[n].triangle[at] >= 0) return leaves[n].distance[at];
  }
  const Vec3 point = coarse_.origin + settings_.fine_spacing * Vec3(node[0], node[1], node[2]);
  return static_cast<float>(trilinear(coarse_cell_at(into_coarse(point))));
}

Vec3 DistanceGrid::into_coarse(const Vec3& p) const {
  const Vec3 last(coarse_.nodes[0] - 1, coarse_.nodes[1] - 1, coarse_.nodes[2] - 1);
  return p.cwiseMax(coarse_.origin).cwiseMin(coarse_.origin + coarse_.spacing * last);
}

DistanceGrid::Cell DistanceGrid::cell_at(const Vec3& p) const {
  const Vec3 from = p - coarse_.origin;
  const Vec3 fine = from / settings_.fine_spacing;
  std::array<int, 3> cell, brick;
  for (int k = 0; k < 3; ++k) {
    cell[k] = std::clamp(static_cast<int>(fine[k]), 0, bricks_[k] * kBrick - 1);
    brick[k] = cell[k] / kBrick;
  }
  const int index = brick_at(brick);
  if (index >= 0) {
    constexpr int n = kBrickNodes;
    const size_t first =
        static_cast<size_t>(index) * n * n * n + ((cell[2] % kBrick) * n + cell[1] % kBrick) * n + cell[0] % kBrick;
    return {&brick_values_[first], n, n * n, fine - Vec3(cell[0], cell[1], cell[2]), settings_.fine_spacing};
  }
  return coarse_cell_at(p);
}

DistanceGrid::Cell DistanceGrid::coarse_cell_at(const Vec3& p) const {
  const Vec3 coarse = (p - coarse_.origin) / coarse_.spacing;
  std::array<int, 3> cell;
  // The outermost cells have no stencil of their own and extrapolate that of their neighbour.
  for (int k = 0; k < 3; ++k) cell[k] = std::clamp(static_cast<int>(coarse[k]), 1, coarse_.nodes[k] - 3);
  return {&coarse_values_[coarse_.index(cell[0] - 1, cell[1] - 1, cell[2] - 1)], coarse_.nodes[0],
          coarse_.nodes[0] * coarse_.nodes[1], coarse - Vec3(cell[0], cell[1], cell[2]), coarse_.spacing};
}

double DistanceGrid::trilinear(const Cell& cell) {
  const auto row = [&](int b, int c) {
    const float* r = cell.first + b * cell.stride_y + c * cell.stride_z;
    return mix(r[1], r[2], cell.at.x());
  };
  return mix(mix(row(1, 1), row(2, 1), cell.at.y()), mix(row(1, 2), row(2, 2), cell.at.y()), cell.at.z());
}

double DistanceGrid::distance(const Vec3& p) const {
  const Vec3 within = into_coarse(p);
  const double value = trilinear(cell_at(within));
  const double beyond = (p - within).norm();
  return beyond > 0 ? std::hypot(value, beyond) : value;
}

FieldSample DistanceGrid::sample(const Vec3& p) const {
  const Vec3 within = into_coarse(p);
  const Cell cell = cell_at(within);
  const auto [x, y, z] = std::array{cell.at.x(), cell.at.y(), cell.at.z()};
  const auto value = [&](int a, int b, int c) -> double {
    return cell.first[a + b * cell.stride_y + c * cell.stride_z];
  };
  // The field on the four planes of the stencil across each axis, at the point's place within the plane.
  std::array<double, 4> across_x, across_y, across_z;
  for (int i = 0; i < 4; ++i) {
    across_x[i] = mix(mix(value(i, 1, 1), value(i, 2, 1), y), mix(value(i, 1, 2), value(i, 2, 2), y), z);
    across_y[i] = mix(mix(value(1, i, 1), value(2, i, 1), x), mix(value(1, i, 2), value(2, i, 2), x), z);
    across_z[i] = mix(mix(value(1, 1, i), value(2, 1, i), x), mix(value(1, 2, i), value(2, 2, i), x), y);
  }
  const auto slope = [](const std::array<double, 4>& f, double t) { return mix(f[2] - f[0], f[3] - f[1], t); };
  Vec3 gradient(slope(across_x, x), slope(across_y, y), slope(across_z, z));
  gradient /= 2 * cell.spacing;
  double distance = mix(across_x[1], across_x[2], x);
  const Vec3 beyond = p - within;
  if (beyond.squaredNorm() > 0) {
    gradient = distance * gradient + beyond;
    distance = std::hypot(distance, beyond.norm());
  }
  const double length = gradient.norm();
  // On a medial axis the differences cancel; any direction is as near as another there.
  return {distance, length > 1e-6 ? Vec3(gradient / length) : Vec3::UnitY()};
}

}  // namespace toile
