#include "engine/terms/bending.h"

#include "engine/geometry/dihedral.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile {

namespace {

/// A steeper angle gradient [1/m] belongs to a hinge with a triangle under 1 µm high: its direction is noise, and its
/// square would leave single precision.
constexpr double kSteepest = 1e6;

/// One triangle's view of one of its edges.
struct Side {
  int low, high;  ///< the edge's ends, sorted
  int triangle, corner;
};

double angle_of(const BendingStencil&, const StencilPoints<4>& x) { return dihedral_angle(x[0], x[1], x[2], x[3]); }

StencilVector<4> gradient_of(const StencilPoints<4>& x) { return dihedral_angle_gradient(x[0], x[1], x[2], x[3]); }

StencilVector<4> stacked(const StencilPoints<4>& v) {
  StencilVector<4> s;
  for (int i = 0; i < 4; ++i) s.segment<3>(3 * i) = v[i];
  return s;
}

std::vector<Side> sorted_sides(const Cloth& cloth) {
  std::vector<Side> sides;
  sides.reserve(3 * cloth.triangles.size());
  for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = cloth.triangles[t][(c + 1) % 3], b = cloth.triangles[t][(c + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, c});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

/// What one side of a hinge brings from its flat panel.
struct FlatSide {
  double length, area, bending, damping;
};

FlatSide flat_side(const Cloth& cloth, const Side& side) {
  const auto& flat = cloth.flat[side.triangle];
  const Vec2 edge = flat[(side.corner + 2) % 3] - flat[(side.corner + 1) % 3];
  const Vec2 other = flat[side.corner] - flat[(side.corner + 1) % 3];
  const Fabric& fabric = cloth.fabrics.at(cloth.panels.at(cloth.triangle_panel[side.triangle]).fabric);
  const double normal_angle = std::atan2(edge.x(), -edge.y());
  return {edge.norm(), 0.5 * std::abs(edge.x() * other.y() - edge.y() * other.x()),
          hinge_bending_stiffness(fabric.bending_stiffness, normal_angle), fabric.bending_damping};
}

}  // namespace

double hinge_bending_stiffness(const Directional& bending, double angle) {
  const double mean = 0.5 * (bending.warp + bending.weft);
  const double d0 = 0.5 * (mean + bending.bias);
  const double d2 = 0.5 * (bending.weft - bending.warp);
  const double d4 = 0.5 * (mean - bending.bias);
  const double least = 0.1 * std::min({bending.warp, bending.weft, bending.bias});
  return std::max(least, d0 + 1.5 * d2 * std::cos(2 * angle) + d4 * std::cos(4 * angle));
}

std::vector<BendingStencil> bending_stencils(const Cloth& cloth) {
  const std::vector<Side> sides = sorted_sides(cloth);
  std::vector<BendingStencil> stencils;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &first = sides[i], &second = sides[i + 1];
    if (first.low != second.low || first.high != second.high) continue;
    const Triangle& t = cloth.triangles[first.triangle];
    BendingStencil s;
    s.nodes = {t[(first.corner + 1) % 3], t[(first.corner + 2) % 3], t[first.corner],
               cloth.triangles[second.triangle][second.corner]};
    const FlatSide a = flat_side(cloth, first), b = flat_side(cloth, second);
    const double length = 0.5 * (a.length + b.length);
    s.stiffness = 0.5 * (a.bending + b.bending) * length * length / (a.area + b.area);
    s.rest_angle = 0;
    s.damping = 0.5 * (a.damping + b.damping);
    stencils.push_back(s);
  }
  return stencils;
}

double bending_energy(const BendingStencil& s, const StencilPoints<4>& x) {
  const double off = angle_of(s, x) - s.rest_angle;
  return 0.5 * s.stiffness * off * off;
}

StencilVector<4> bending_gradient(const BendingStencil& s, const StencilPoints<4>& x) {
  return s.stiffness * (angle_of(s, x) - s.rest_angle) * gradient_of(x);
}

StencilMatrix<4> bending_hessian(const BendingStencil& s, const StencilPoints<4>& x) {
  return bending_hessian_psd(s, x) +
         s.stiffness * (angle_of(s, x) - s.rest_angle) * dihedral_angle_hessian(x[0], x[1], x[2], x[3]);
}

StencilMatrix<4> bending_hessian_psd(const BendingStencil& s, const StencilPoints<4>& x) {
  const StencilVector<4> g = gradient_of(x);
  return s.stiffness * g * g.transpose();
}

double bending_dissipation(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v) {
  const double rate = gradient_of(x).dot(stacked(v));
  return 0.5 * s.damping * s.stiffness * rate * rate;
}

StencilVector<4> bending_dissipation_gradient(const BendingStencil& s, const StencilPoints<4>& x,
                                              const StencilPoints<4>& v) {
  const StencilVector<4> g = gradient_of(x);
  return s.damping * s.stiffness * g.dot(stacked(v)) * g;
}

StencilMatrix<4> bending_dissipation_hessian(const BendingStencil& s, const StencilPoints<4>& x) {
  return s.damping * bending_hessian_psd(s, x);
}

std::array<Vec3, 4> bending_force(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v,
                                  double fabric_factor) {
  const StencilVector<4> g = gradient_of(x);
  std::array<Vec3, 4> force;
  if (!(g.squaredNorm() < kSteepest * kSteepest)) {
    force.fill(Vec3::Zero());
    return force;
  }
  const double moment = -fabric_factor * s.stiffness * (angle_of(s, x) - s.rest_angle + s.damping * g.dot(stacked(v)));
  for (int i = 0; i < 4; ++i) force[i] = moment * g.segment<3>(3 * i);
  return force;
}

void bending_response(const BendingStencil& s, const StencilPoints<4>& x, const StencilPoints<4>& v,
                      const SystemWeights& weights, BendingResponse& out) {
  const StencilVector<4> g = gradient_of(x);
  if (!(g.squaredNorm() < kSteepest * kSteepest)) {
    out.force.fill(Vec3::Zero());
    out.row.fill(Eigen::Vector3f::Zero());
    return;
  }
  const double k = weights.fabric * s.stiffness;
  const double moment = -k * (angle_of(s, x) - s.rest_angle + s.damping * g.dot(stacked(v)));
  const double root = std::sqrt(k * (weights.stiffness + weights.dissipation * s.damping));
  for (int i = 0; i < 4; ++i) {
    out.force[i] = moment * g.segment<3>(3 * i);
    out.row[i] = (root * g.segment<3>(3 * i)).cast<float>();
  }
}

}  // namespace toile
