#pragma once
// Where the eye and the key light stand, and what of space they see.

#include <Eigen/Core>
#include <span>

#include "render/picture.h"

namespace toile {

/// A box that holds what the picture is about.
struct Frame {
  Vec3 low = Vec3::Constant(-0.5), high = Vec3::Constant(0.5);  ///< [m]

  Vec3 centre() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low).norm(); }  ///< [m]
};

/// The box of garment and body. A body that reaches far beyond the garment (a ground plane) is cut to
/// kBodyReach times the garment's size, so that it does not make the garment small. A default box for an empty subject.
Frame frame_of(const Subject& subject);
inline constexpr double kBodyReach = 3;

/// A perspective camera of an 85 mm lens on 36 × 24 mm (16.1° over the shorter side): little foreshortening.
/// Matrices act on points relative to the frame's centre.
struct Camera {
  Eigen::Matrix4f view, projection;
  Vec3 eye, right, up, back;    ///< eye relative to the frame's centre; `back` points from the subject to the eye
  double tangent_x, tangent_y;  ///< of half the field of view
  double shift_x;               ///< of the subject's centre, in clip space: makes room for a legend
};

/// A camera that shows the whole frame with a margin, the rightmost `reserved` of `width` pixels left free.
Camera camera_for(View view, const Subject& subject, const Frame& frame, int width, int height, int reserved);

/// The key light: from the camera's upper left, so that every view is lit alike. An orthographic shadow camera.
struct KeyLight {
  Vec3 towards;  ///< unit, from the subject to the light
  Vec3 fill;     ///< unit, the direction of the fill light
  Eigen::Matrix4f view, projection;
};
KeyLight key_light(const Camera& camera, double radius);

}  // namespace toile
