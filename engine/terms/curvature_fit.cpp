#include "engine/terms/curvature_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double kLeastTwist = 0.01;    // T₆₆ over √(warp·weft)
constexpr double kMostCoupling = 0.99;  // |T₁₂| over √(warp·weft)
constexpr double kFlattestFit = 0.2;    // least singular value of B over the largest; √½ in an equilateral mesh

/// (n t) as a row: its product with (κ_uu, κ_vv, 2 κ_uv) is nᵀ κ t.
Vec3 component(const Vec2& n, const Vec2& t) {
  return {n.x() * t.x(), n.y() * t.y(), 0.5 * (n.x() * t.y() + n.y() * t.x())};
}

/// Where two rows of a hinge's near wing come from: ½ h κ_nn − ½ s (l − s)/h κ_tt.
Vec3 wing_row(const Vec2& along, const Vec2& across, double length, const Wing& wing) {
  return 0.5 * wing.height * component(across, across) -
         0.5 * wing.foot * (length - wing.foot) / wing.height * component(along, along);
}

}  // namespace

Mat3 directional_tensor(const Directional& values) {
  const double scale = std::sqrt(values.warp * values.weft), least = kLeastTwist * scale;
  const double mean = 0.25 * (values.warp + values.weft);
  const double twist = std::max(values.bias - mean, least);
  const double coupling = std::clamp(2 * (values.bias - mean - twist), -kMostCoupling * scale, 0.0);
  Mat3 tensor;
  tensor << values.weft, coupling, 0, coupling, values.warp, 0, 0, 0, twist;
  return tensor;
}

Vec3 hinge_row(const Vec2& along, const Vec2& across, double length, const Wing& near, const Wing& far) {
  return wing_row(along, across, length, near) + wing_row(along, across, length, far) +
         (near.foot - far.foot) * component(across, along);
}

Vec3 clamped_hinge_row(const Vec2& along, const Vec2& across, double length, const Wing& near) {
  return wing_row(along, across, length, near) + (near.foot - 0.5 * length) * component(across, along);
}

CurvatureFit fit_curvature(const std::array<Vec3, 3>& rows, const std::array<bool, 3>& present, const Mat3& stiffness,
                           double area) {
  // In the metric of tensors |κ|² = κ_uu² + κ_vv² + ½ (2 κ_uv)² a rotation of the pattern changes no singular value.
  const Vec3 metric(1, 1, std::sqrt(2.0));
  std::array<int, 3> hinge{};
  int count = 0;
  for (int i = 0; i < 3; ++i)
    if (present[i]) hinge[count++] = i;
  CurvatureFit result{Mat3::Zero(), Mat3::Zero()};
  if (count == 0) return result;

  Eigen::MatrixXd b(count, 3);
  for (int i = 0; i < count; ++i) b.row(i) = rows[hinge[i]].cwiseProduct(metric).transpose();
  if (!b.allFinite()) return result;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(b, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd raised = svd.singularValues().cwiseMax(kFlattestFit * svd.singularValues()[0]);
  if (raised != svd.singularValues()) b = svd.matrixU() * raised.asDiagonal() * svd.matrixV().transpose();
  b *= metric.cwiseInverse().asDiagonal();

  const Eigen::MatrixXd compliance = stiffness.llt().solve(b.transpose());  // D⁻¹ Bᵀ
  const Eigen::MatrixXd k = area * (b * compliance).inverse();
  const Eigen::MatrixXd fit = compliance * k / area;
  const Eigen::MatrixXd factor = Eigen::LLT<Eigen::MatrixXd>(0.5 * (k + k.transpose())).matrixU();
  for (int i = 0; i < count; ++i) {
    result.fit.col(hinge[i]) = fit.col(i);
    for (int j = 0; j < count; ++j) result.factor(j, hinge[i]) = factor(j, i);
  }
  return result;
}

}  // namespace toile
