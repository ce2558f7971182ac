#include "engine/geometry/dress_form.h"

#include "engine/geometry/dress_form_shape.h"
#include "engine/geometry/openvdb_templates.h"
#include "engine/parallel/parallel_for.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {

namespace {

constexpr double kVoxelOverHeight = 0.0085;  ///< 15 mm at 1.72 m: about 20,000 triangles
constexpr int kBand = 3;                     ///< voxels of the level set on either side
constexpr int kSmoothing = 4;                ///< rounds of evening out the mesh
constexpr int kGirthRounds = 20;
constexpr double kGirthTolerance = 1e-4;  ///< relative

double hull_perimeter(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  const auto half = [&](auto begin, auto end) {
    std::vector<Vec2> chain;
    for (auto p = begin; p != end; ++p) {
      while (chain.size() > 1) {
        const Vec2 u = chain.back() - chain[chain.size() - 2], v = *p - chain.back();
        if (u.x() * v.y() - u.y() * v.x() > 0) break;
        chain.pop_back();
      }
      chain.push_back(*p);
    }
    double length = 0;
    for (size_t i = 1; i < chain.size(); ++i) length += (chain[i] - chain[i - 1]).norm();
    return length;
  };
  return half(points.begin(), points.end()) + half(points.rbegin(), points.rend());
}

/// What a tape around the trunk measures at this height: the hull of the cut, found along rays from the middle.
double girth(const DressFormShape& shape, double height) {
  constexpr int kRays = 180;
  std::vector<Vec2> cut;
  for (int i = 0; i <= kRays; ++i) {
    const double angle = std::numbers::pi * (i / double(kRays) - 0.5);
    const Vec2 ray(std::cos(angle), std::sin(angle));
    const auto outside = [&](double r) { return shape.trunk({r * ray.x(), height, r * ray.y()}) > 0; };
    double high = 0.01;
    while (!outside(high) && high < 2) high += 0.01;
    double low = high - 0.01;
    for (int k = 0; k < 30; ++k) (outside(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    cut.push_back(low * ray);
    cut.push_back({-low * ray.x(), low * ray.y()});
  }
  return hull_perimeter(cut);
}

DressFormShape fitted_shape(const DressFormBody& body) {
  const DressFormMeasures lines = dress_form_measures(body);
  GirthScale scale;
  for (int round = 0; round < kGirthRounds; ++round) {
    const DressFormShape shape(body, scale);
    double worst = 0;
    const auto adjust = [&](double& factor, double wanted, double height) {
      const double ratio = wanted / girth(shape, height);
      worst = std::max(worst, std::abs(ratio - 1));
      factor *= ratio;
    };
    adjust(scale.bust, body.bust, lines.bust);
    adjust(scale.waist, body.waist, lines.waist);
    adjust(scale.hip, body.hip, lines.hip);
    adjust(scale.neck, body.neck, lines.neck);
    if (worst < kGirthTolerance) break;
  }
  return DressFormShape(body, scale);
}

openvdb::FloatGrid::Ptr level_set(const DressFormShape& shape, const DressFormBody& body, double voxel) {
  openvdb::initialize();
  const double band = kBand * voxel;
  auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  const int half_x = static_cast<int>(std::ceil(0.5 * body.height / voxel));
  const int half_z = static_cast<int>(std::ceil((0.35 * std::max(body.bust, body.hip) + band) / voxel));
  const int top = static_cast<int>(std::ceil(0.95 * body.height / voxel)), bottom = -kBand - 1;
  const int rows = 2 * half_z + 1, columns = 2 * half_x + 1;
  std::vector<float> layer(static_cast<size_t>(rows) * columns);
  auto accessor = grid->getAccessor();
  for (int j = bottom; j <= top; ++j) {
    parallel_for_each(rows, 1, [&](int k) {
      for (int i = 0; i < columns; ++i) {
        layer[k * columns + i] = static_cast<float>(shape(voxel * Vec3(i - half_x, j, k - half_z)));
      }
    });
    for (int k = 0; k < rows; ++k) {
      for (int i = 0; i < columns; ++i) {
        const float value = layer[k * columns + i];
        if (std::abs(value) < band) accessor.setValue({i - half_x, j, k - half_z}, value);
      }
    }
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

TriangleMesh triangulated(const openvdb::FloatGrid& grid) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, quads, 0.0);
  TriangleMesh mesh;
  for (const openvdb::Vec3s& p : points) mesh.vertices.push_back({p.x(), p.y(), p.z()});
  for (const openvdb::Vec4I& q : quads) {
    const std::array<int, 4> v{int(q[3]), int(q[2]), int(q[1]), int(q[0])};  // OpenVDB's quads are clockwise
    const auto length = [&](int a, int b) { return (mesh.vertices[v[a]] - mesh.vertices[v[b]]).squaredNorm(); };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    const auto at = [&](int i) { return v[(first + i) % 4]; };
    mesh.triangles.push_back({at(0), at(1), at(2)});
    mesh.triangles.push_back({at(0), at(2), at(3)});
  }
  return mesh;
}

/// Draws each vertex to the middle of its neighbours and back to the surface.
void even_out(TriangleMesh& mesh, const DressFormShape& shape) {
  std::vector<Vec3> sum(mesh.vertices.size());
  std::vector<int> count(mesh.vertices.size());
  for (int round = 0; round < kSmoothing; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    std::fill(count.begin(), count.end(), 0);
    for (const Triangle& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += mesh.vertices[t[(k + 1) % 3]] + mesh.vertices[t[(k + 2) % 3]];
        count[t[k]] += 2;
      }
    }
    parallel_for_each(static_cast<int>(mesh.vertices.size()), 64, [&](int v) {
      Vec3 x = 0.5 * mesh.vertices[v] + 0.5 * sum[v] / count[v];
      for (int newton = 0; newton < 3; ++newton) {
        constexpr double d = 1e-4;
        const double value = shape(x);
        const Vec3 slope = Vec3(shape(x + d * Vec3::UnitX()) - shape(x - d * Vec3::UnitX()),
                                shape(x + d * Vec3::UnitY()) - shape(x - d * Vec3::UnitY()),
                                shape(x + d * Vec3::UnitZ()) - shape(x - d * Vec3::UnitZ())) /
                           (2 * d);
        // Never by more than a fraction of a voxel: where solids meet the slope is small.
        x -= std::clamp(value / std::max(slope.squaredNorm(), 0.25), -0.004, 0.004) * slope;
      }
      mesh.vertices[v] = x;
    });
  }
}

}  // namespace

DressFormMeasures dress_form_measures(const DressFormBody& body) {
  const double h = body.height;
  DressFormMeasures m;
  m.neck = 0.866 * h;
  m.neck_base = 0.85 * h;
  m.shoulder = 0.82 * h;
  m.underarm = 0.762 * h;
  m.bust = 0.725 * h;
  m.underbust = 0.685 * h;
  m.waist = 0.62 * h;
  m.high_hip = 0.565 * h;
  m.hip = 0.51 * h;
  m.crotch = 0.465 * h;
  m.knee = 0.275 * h;
  m.shoulder_half_width = 0.5 * body.shoulder_width;
  m.arm_angle = 42 * std::numbers::pi / 180;
  m.arm_radius = 0.05 * std::sqrt(body.bust / 0.92);
  m.arm_length = 0.16 * h;
  return m;
}

TriangleMesh dress_form(const DressFormBody& body) {
  const DressFormShape shape = fitted_shape(body);
  TriangleMesh mesh = triangulated(*level_set(shape, body, kVoxelOverHeight * body.height));
  even_out(mesh, shape);
  return mesh;
}

}  // namespace toile
