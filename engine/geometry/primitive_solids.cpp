#include "engine/geometry/primitive_solids.h"

#include "engine/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSlices = 64;             ///< of a surface of revolution, for pictures
constexpr double kPlaneHalfSize = 2.0;  ///< [m], of the square that stands for a half space in pictures

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : otherwise;
}

Vec3 any_perpendicular(const Vec3& axis) {
  int least;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3::Unit(least)).normalized();
}

/// Turns a profile (radius, height along the axis), given from the bottom pole to the top pole, about the axis.
TriangleMesh lathe(const std::vector<Vec2>& profile, const Vec3& origin, const Vec3& axis) {
  const Vec3 side = any_perpendicular(axis), across = axis.cross(side);
  TriangleMesh mesh;
  std::vector<int> ring_start;
  for (const Vec2& p : profile) {
    ring_start.push_back(static_cast<int>(mesh.vertices.size()));
    const int count = p.x() > 0 ? kSlices : 1;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSlices;
      mesh.vertices.push_back(origin + p.y() * axis + p.x() * (std::cos(angle) * side + std::sin(angle) * across));
    }
  }
  for (size_t r = 0; r + 1 < profile.size(); ++r) {
    const bool low_pole = profile[r].x() <= 0, high_pole = profile[r + 1].x() <= 0;
    for (int i = 0; i < kSlices; ++i) {
      const int j = (i + 1) % kSlices;
      const auto low = [&](int k) { return ring_start[r] + (low_pole ? 0 : k); };
      const auto high = [&](int k) { return ring_start[r + 1] + (high_pole ? 0 : k); };
      if (!low_pole) mesh.triangles.push_back({low(i), low(j), high(i)});
      if (!high_pole) mesh.triangles.push_back({low(j), high(j), high(i)});
    }
  }
  return mesh;
}

/// Half circles of a sphere-swept segment of this length along the axis, from pole to pole.
std::vector<Vec2> capsule_profile(double radius, double length) {
  std::vector<Vec2> profile;
  constexpr int kHalf = kSlices / 4;
  for (int i = 0; i <= 2 * kHalf + (length > 0 ? 1 : 0); ++i) {
    const bool top = length > 0 ? i > kHalf : i >= kHalf;
    const int step = length > 0 && top ? i - 1 : i;
    const double angle = std::numbers::pi * (step - kHalf) / (2.0 * kHalf);
    const bool pole = step == 0 || step == 2 * kHalf;
    profile.push_back({pole ? 0 : radius * std::cos(angle), radius * std::sin(angle) + (top ? length : 0)});
  }
  return profile;
}

/// Distance from the axis-aligned box |q| <= half in any dimension, and its gradient in `normal`.
template <typename Vector>
double box_distance(const Vector& q, const Vector& half, Vector& normal) {
  const Vector side = q.unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
  const Vector beyond = q.cwiseAbs() - half;
  int axis;
  const double largest = beyond.maxCoeff(&axis);
  if (largest <= 0) {
    normal = Vector::Zero();
    normal[axis] = side[axis];
    return largest;
  }
  const Vector outside = beyond.cwiseMax(0.0);
  const double distance = outside.norm();
  normal = (outside / distance).cwiseProduct(side);
  return distance;
}

class ExactSolid : public Solid {
 public:
  double distance(const Vec3& point) const final { return sample(point).distance; }
  double band() const final { return kInfinity; }
};

class CapsuleSolid final : public ExactSolid {
 public:
  explicit CapsuleSolid(const CapsuleBody& capsule) : c_(capsule) {
    axis_ = unit_or(c_.end - c_.start, Vec3::UnitY());
    side_ = c_.end == c_.start ? Vec3::UnitY() : any_perpendicular(axis_);
  }
  FieldSample sample(const Vec3& p) const override {
    const Vec3 foot = c_.start + point_segment(p, c_.start, c_.end).t * (c_.end - c_.start);
    const Vec3 away = p - foot;
    return {away.norm() - c_.radius, unit_or(away, side_)};
  }
  Box bounds() const override { return Box{c_.start.cwiseMin(c_.end), c_.start.cwiseMax(c_.end)}.inflated(c_.radius); }
  TriangleMesh surface() const override {
    return lathe(capsule_profile(c_.radius, (c_.end - c_.start).norm()), c_.start, axis_);
  }

 private:
  CapsuleBody c_;
  Vec3 axis_, side_;
};

class CylinderSolid final : public ExactSolid {
 public:
  explicit CylinderSolid(const CylinderBody& cylinder) : c_(cylinder) {
    axis_ = unit_or(c_.end - c_.start, Vec3::UnitY());
    half_length_ = 0.5 * (c_.end - c_.start).norm();
  }
  FieldSample sample(const Vec3& p) const override {
    const Vec3 from_middle = p - 0.5 * (c_.start + c_.end);
    const double along = from_middle.dot(axis_);
    const Vec3 radial = from_middle - along * axis_;
    Vec2 normal;
    const double distance = box_distance(Vec2(radial.norm(), along), Vec2(c_.radius, half_length_), normal);
    return {distance, normal.x() * unit_or(radial, any_perpendicular(axis_)) + normal.y() * axis_};
  }
  Box bounds() const override {
    const Vec3 reach = c_.radius * (1 - axis_.array().square()).max(0.0).sqrt();
    return {c_.start.cwiseMin(c_.end) - reach, c_.start.cwiseMax(c_.end) + reach};
  }
  TriangleMesh surface() const override {
    return lathe({{0, 0}, {c_.radius, 0}, {c_.radius, 2 * half_length_}, {0, 2 * half_length_}}, c_.start, axis_);
  }

 private:
  CylinderBody c_;
  Vec3 axis_;
  double half_length_;
};

class BoxSolid final : public ExactSolid {
 public:
  explicit BoxSolid(const BoxBody& box) : b_(box) {}
  FieldSample sample(const Vec3& p) const override {
    Vec3 normal;
    const double distance = box_distance(Vec3(b_.rotation.transpose() * (p - b_.center)), b_.half_extents, normal);
    return {distance, b_.rotation * normal};
  }
  Box bounds() const override {
    const Vec3 reach = b_.rotation.cwiseAbs() * b_.half_extents;
    return {b_.center - reach, b_.center + reach};
  }
  TriangleMesh surface() const override {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
      const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      mesh.vertices.push_back(b_.center + b_.rotation * sign.cwiseProduct(b_.half_extents));
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
  }

 private:
  BoxBody b_;
};

class PlaneSolid final : public ExactSolid {
 public:
  explicit PlaneSolid(const PlaneBody& plane) : point_(plane.point), normal_(unit_or(plane.normal, Vec3::UnitY())) {}
  FieldSample sample(const Vec3& p) const override { return {normal_.dot(p - point_), normal_}; }
  Box bounds() const override { return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)}; }
  TriangleMesh surface() const override {
    const Vec3 u = kPlaneHalfSize * any_perpendicular(normal_), v = normal_.cross(u);
    TriangleMesh mesh;
    mesh.vertices = {point_ - u - v, point_ + u - v, point_ + u + v, point_ - u + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  }

 private:
  Vec3 point_, normal_;
};

}  // namespace

std::shared_ptr<const Solid> make_solid(const SphereBody& sphere) {
  return std::make_shared<CapsuleSolid>(CapsuleBody{sphere.center, sphere.center, sphere.radius});
}
std::shared_ptr<const Solid> make_solid(const CapsuleBody& capsule) { return std::make_shared<CapsuleSolid>(capsule); }
std::shared_ptr<const Solid> make_solid(const CylinderBody& cylinder) {
  return std::make_shared<CylinderSolid>(cylinder);
}
std::shared_ptr<const Solid> make_solid(const BoxBody& box) { return std::make_shared<BoxSolid>(box); }
std::shared_ptr<const Solid> make_solid(const PlaneBody& plane) { return std::make_shared<PlaneSolid>(plane); }

}  // namespace toile
