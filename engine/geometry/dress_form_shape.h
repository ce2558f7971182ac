#pragma once
// The dress form as an implicit function: lofted cross-sections, smoothly united. Internal to dress_form.cpp.

#include "engine/geometry/dress_form.h"
#include "engine/types.h"

#include <vector>

namespace toile {

/// Smooth curve through stations at rising heights: cubic Hermite, tangents limited so that it does not overshoot
/// (Fritsch & Carlson 1980). Constant beyond the ends.
class StationCurve {
 public:
  StationCurve() = default;
  StationCurve(std::vector<double> heights, std::vector<double> values);
  double operator()(double height) const;

 private:
  std::vector<double> heights_, values_, slopes_;
};

/// Factors on the cross-sections at the lines where girths are asked for; found by dress_form().
struct GirthScale {
  double bust = 1, waist = 1, hip = 1, neck = 1;
};

class DressFormShape {
 public:
  DressFormShape(const DressFormBody& body, const GirthScale& scale);

  /// About the signed distance [m] near the surface, negative inside; smooth but for the planes x = 0.
  double operator()(const Vec3& point) const;
  /// The same without the arms.
  double trunk(const Vec3& point) const;

 private:
  double torso(const Vec3& point) const;
  double leg(const Vec3& point) const;
  double arm(const Vec3& point) const;

  DressFormMeasures lines_;
  double height_, bust_radius_, bust_x_, bust_z_, seat_radius_, seat_x_, seat_z_;
  StationCurve half_width_, half_depth_, middle_z_;  ///< of the torso and neck
  StationCurve leg_radius_, leg_x_, leg_z_;
};

}  // namespace toile
