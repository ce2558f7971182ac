#pragma once
// The built-in mannequin: a parametric dress form, so that a garment can be draped without anyone's body data.

#include "engine/mesh/triangle_mesh.h"
#include "engine/scene/body.h"

namespace toile {

/// Where the tape lies [m]: heights of the horizontal lines above the floor, and the points that patterns are drawn to.
struct DressFormMeasures {
  double neck = 0;       ///< where its girth is taken, a little above its base
  double neck_base = 0;  ///< where the line of the shoulders meets it
  double shoulder = 0;   ///< of the shoulder point
  double underarm = 0;   ///< where arm and torso part
  double bust = 0, underbust = 0, waist = 0, high_hip = 0, hip = 0, crotch = 0, knee = 0;
  double shoulder_half_width = 0;  ///< x of the shoulder point
  double arm_angle = 0;            ///< of the arm's axis below the horizontal [rad]
  double arm_radius = 0;           ///< of the upper arm
  double arm_length = 0;           ///< along the axis, from the shoulder point to the end of the stump
};
DressFormMeasures dress_form_measures(const DressFormBody& body);

/// Closed, symmetric in x, about 20,000 triangles: torso, neck without head, arm stumps in an A-pose, legs to the
/// floor. Girths at bust, waist, hip and neck measured with a closed tape (the convex hull of the horizontal cut; at
/// the bust and hip of the torso without arms) are those asked for within 1 %. Deterministic.
TriangleMesh dress_form(const DressFormBody& body);

}  // namespace toile
