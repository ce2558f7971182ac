#include "engine/solve/trim_shape.h"

#include "engine/geometry/primitive_solids.h"

#include <cmath>
#include <numbers>

namespace toile {

TrimShape disc_shape(double diameter, double thickness) {
  constexpr int kRim = 16;  // points around it
  const double radius = 0.5 * diameter;
  const Vec3 half = 0.5 * thickness * Vec3::UnitZ();
  TrimShape shape{make_solid(CylinderBody{-half, half, radius}), {}, std::hypot(radius, half.z()), radius};
  for (const Vec3& face : {Vec3(-half), half}) {
    const auto add = [&](double off, double turns) {
      const double angle = 2 * std::numbers::pi * turns;
      shape.points.push_back(face + off * Vec3(std::cos(angle), std::sin(angle), 0));
    };
    add(0, 0);
    for (int k = 0; k < kRim / 2; ++k) add(0.5 * radius, 2.0 * k / kRim);
    for (int k = 0; k < kRim; ++k) add(radius, 1.0 * k / kRim);
  }
  return shape;
}

TrimShape box_shape(const Vec3& size) {
  const Vec3 half = 0.5 * size;
  TrimShape shape{
      make_solid(BoxBody{Vec3::Zero(), half, Mat3::Identity()}), {}, half.norm(), std::min(half.x(), half.y())};
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if (i != 0 || j != 0 || k != 0) shape.points.push_back(Vec3(i, j, k).cwiseProduct(half));
  return shape;
}

}  // namespace toile
