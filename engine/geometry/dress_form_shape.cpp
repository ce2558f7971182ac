#include "engine/geometry/dress_form_shape.h"

#include "engine/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {

namespace {

constexpr double kRoundness = 2.3;  ///< exponent of the torso's superellipses: a little squarer than an ellipse

/// Polynomial smooth minimum (Quilez): the union of two solids with a fillet of about `blend` [m].
double smooth_union(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - 0.25 * h * h * blend;
}
double smooth_intersection(double a, double b, double blend) { return -smooth_union(-a, -b, blend); }

/// About the distance from an ellipsoid: Quilez's bound, exact on the surface to first order.
double ellipsoid(const Vec3& from_center, const Vec3& radii) {
  const double k0 = from_center.cwiseQuotient(radii).norm();
  const double k1 = from_center.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -radii.minCoeff();
}

/// Half width of an ellipse whose half depth is `ratio` times that, of this girth (Ramanujan 1914).
double half_width_of(double girth, double ratio) {
  const double h = std::pow((1 - ratio) / (1 + ratio), 2);
  return girth / (std::numbers::pi * (1 + ratio) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h))));
}

}  // namespace

StationCurve::StationCurve(std::vector<double> heights, std::vector<double> values)
    : heights_(std::move(heights)), values_(std::move(values)), slopes_(values_.size(), 0.0) {
  for (size_t i = 1; i + 1 < values_.size(); ++i) {
    const double before = heights_[i] - heights_[i - 1], after = heights_[i + 1] - heights_[i];
    const double low = (values_[i] - values_[i - 1]) / before, high = (values_[i + 1] - values_[i]) / after;
    if (low * high <= 0) continue;
    const double w1 = 2 * after + before, w2 = after + 2 * before;
    slopes_[i] = (w1 + w2) / (w1 / low + w2 / high);
  }
}

double StationCurve::operator()(double height) const {
  if (height <= heights_.front()) return values_.front();
  if (height >= heights_.back()) return values_.back();
  const size_t i = std::upper_bound(heights_.begin(), heights_.end(), height) - heights_.begin() - 1;
  const double step = heights_[i + 1] - heights_[i], t = (height - heights_[i]) / step;
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * values_[i] + (t3 - 2 * t2 + t) * step * slopes_[i] +
         (3 * t2 - 2 * t3) * values_[i + 1] + (t3 - t2) * step * slopes_[i + 1];
}

DressFormShape::DressFormShape(const DressFormBody& body, const GirthScale& scale)
    : lines_(dress_form_measures(body)), height_(body.height) {
  const double h = body.height;
  // Girth of the ribcage and its ratio of depth to width at each line: proportions of an average woman's figure.
  const double waist = body.waist * scale.waist, hip = body.hip * scale.hip, bust = body.bust * scale.bust;
  struct Station {
    double at, girth, ratio, middle_z;
  };
  const double neck_width = half_width_of(body.neck * scale.neck, 1.0);
  const double shoulder = lines_.shoulder_half_width;
  const std::vector<Station> stations{{lines_.crotch, 0.90 * hip, 0.74, -0.005},
                                      {lines_.hip, 0.98 * hip, 0.70, -0.006},
                                      {lines_.high_hip, waist + 0.66 * (0.97 * hip - waist), 0.71, -0.004},
                                      {lines_.waist, waist, 0.72, 0.004},
                                      {lines_.underbust, waist + 0.45 * (0.93 * bust - waist), 0.72, 0.0},
                                      {lines_.bust, 0.91 * bust, 0.70, -0.004},
                                      {lines_.underarm, 0.90 * bust, 0.64, -0.010}};
  std::vector<double> at, width, depth, middle;
  for (const Station& s : stations) {
    at.push_back(s.at);
    width.push_back(half_width_of(s.girth, s.ratio));
    depth.push_back(s.ratio * width.back());
    middle.push_back(s.middle_z);
  }
  const auto add = [&](double y, double half_width, double half_depth, double z) {
    at.push_back(y);
    width.push_back(half_width);
    depth.push_back(half_depth);
    middle.push_back(z);
  };
  // The line of the shoulders, about 20° from the shoulder point to the neck: the ridge of the yoke follows it.
  const double rise = lines_.neck_base - lines_.shoulder;
  const auto along = [&](double t) { return shoulder + t * (1.10 * neck_width - shoulder); };
  add(lines_.shoulder - 0.7 * rise, 0.87 * shoulder, 0.048 * h * bust / 0.92, -0.015);
  add(lines_.shoulder + 0.1 * rise, 0.83 * along(0.1), 0.040 * h, -0.018);
  add(lines_.shoulder + 0.45 * rise, 0.98 * along(0.45), 0.034 * h, -0.020);
  add(lines_.shoulder + 0.75 * rise, along(0.75), 0.034 * h, -0.018);
  add(lines_.neck_base, 1.10 * neck_width, 1.10 * neck_width, -0.014);
  add(lines_.neck, neck_width, neck_width, -0.008);
  add(lines_.neck + 0.02 * h, 0.98 * neck_width, 0.98 * neck_width, -0.002);
  half_width_ = StationCurve(at, width);
  half_depth_ = StationCurve(at, depth);
  middle_z_ = StationCurve(at, middle);

  bust_radius_ = 0.070 * bust / 0.92;
  bust_x_ = 0.075 * bust / 0.92;
  bust_z_ = middle_z_(lines_.bust) + 0.58 * half_depth_(lines_.bust);
  seat_radius_ = 0.085 * hip / 0.98;
  seat_x_ = 0.068 * hip / 0.98;
  seat_z_ = middle_z_(lines_.hip) - 0.42 * half_depth_(lines_.hip);

  const double leg = hip / 0.98;
  const std::vector<double> leg_at{0, 0.05 * h, 0.20 * h, lines_.knee, 0.40 * h, lines_.crotch, lines_.hip};
  leg_radius_ =
      StationCurve(leg_at, {0.036 * leg, 0.037 * leg, 0.053 * leg, 0.055 * leg, 0.074 * leg, 0.084 * leg, 0.088 * leg});
  leg_x_ =
      StationCurve(leg_at, {0.082 * leg, 0.082 * leg, 0.084 * leg, 0.086 * leg, 0.091 * leg, 0.094 * leg, 0.088 * leg});
  leg_z_ = StationCurve(leg_at, {-0.018, -0.018, -0.015, 0.0, 0.004, -0.002, -0.006});
}

double DressFormShape::torso(const Vec3& p) const {
  // Distance to first order: the level function over its slope, as the cross-section changes with height too.
  const auto level = [this](double x, double y, double z) {
    return std::pow(std::pow(std::abs(x) / half_width_(y), kRoundness) +
                        std::pow(std::abs(z - middle_z_(y)) / half_depth_(y), kRoundness),
                    1 / kRoundness);
  };
  const double value = level(p.x(), p.y(), p.z());
  constexpr double d = 1e-4;
  const Vec3 slope(level(p.x() + d, p.y(), p.z()) - level(p.x() - d, p.y(), p.z()),
                   level(p.x(), p.y() + d, p.z()) - level(p.x(), p.y() - d, p.z()),
                   level(p.x(), p.y(), p.z() + d) - level(p.x(), p.y(), p.z() - d));
  double distance = (value - 1) / std::max(slope.norm() / (2 * d), 1.0);
  distance = smooth_intersection(distance, lines_.crotch - 0.012 * height_ - p.y(), 0.05);
  distance = smooth_intersection(distance, p.y() - (lines_.neck + 0.02 * height_), 0.03);
  const Vec3 mirrored(std::abs(p.x()), p.y(), p.z());
  const Vec3 bust_center(bust_x_, lines_.bust + 0.1 * bust_radius_, bust_z_);
  const Vec3 seat_center(seat_x_, lines_.hip - 0.008 * height_, seat_z_);
  distance = smooth_union(distance, ellipsoid(mirrored - bust_center, bust_radius_ * Vec3(1.05, 1.2, 1.0)), 0.07);
  return smooth_union(distance, ellipsoid(mirrored - seat_center, seat_radius_ * Vec3(0.95, 1.15, 0.95)), 0.06);
}

double DressFormShape::leg(const Vec3& p) const {
  const double y = std::clamp(p.y(), 0.0, lines_.hip);
  const double dx = std::abs(p.x()) - leg_x_(y), dz = p.z() - leg_z_(y);
  const double around = std::hypot(dx, dz) - leg_radius_(y);
  return smooth_intersection(smooth_intersection(around, p.y() - lines_.hip, 0.05), -p.y(), 0.02);
}

double DressFormShape::arm(const Vec3& p) const {
  const Vec3 direction(std::cos(lines_.arm_angle), -std::sin(lines_.arm_angle), 0);
  const double r = lines_.arm_radius;
  const Vec3 start(lines_.shoulder_half_width - 0.75 * r, lines_.shoulder - 0.95 * r, -0.016);
  const Vec3 end = start + lines_.arm_length * direction;
  const PointSegment near = point_segment(Vec3(std::abs(p.x()), p.y(), p.z()), start, end);
  return std::sqrt(near.squared_distance) - r * (1 - 0.2 * near.t);
}

double DressFormShape::trunk(const Vec3& p) const { return smooth_union(torso(p), leg(p), 0.06); }

double DressFormShape::operator()(const Vec3& p) const { return smooth_union(trunk(p), arm(p), 0.05); }

}  // namespace toile
