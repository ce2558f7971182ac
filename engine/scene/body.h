#pragma once
// What a garment hangs on: a mesh, a primitive, or the built-in dress form. All solid, at rest.

#include "engine/mesh/triangle_mesh.h"
#include "engine/types.h"

#include <optional>
#include <variant>

namespace toile {

struct SphereBody {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};
/// Sphere-swept segment.
struct CapsuleBody {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  double radius = 0;
};
/// Solid right cylinder with flat caps at start and end.
struct CylinderBody {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  double radius = 0;
};
/// Oriented box; half extents along the columns of rotation.
struct BoxBody {
  Vec3 center = Vec3::Zero(), half_extents = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};
/// Half space below the plane through `point` with the unit `normal`.
struct PlaneBody {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitY();
};
/// A closed or nearly closed surface; may cross itself and have small holes. Inside is winding number > ½.
struct MeshBody {
  TriangleMesh mesh;
};
/// Parametric mannequin on a stand of no extent: torso, neck, stumps of arms and legs in an A-pose. Girths are closed
/// tape measures. Feet at y = 0, facing +z, wearer's left +x. [m]
struct DressFormBody {
  double height = 1.72, bust = 0.92, waist = 0.74, hip = 0.98, shoulder_width = 0.39, neck = 0.36;
};

struct Body {
  std::variant<MeshBody, SphereBody, CapsuleBody, CylinderBody, BoxBody, PlaneBody, DressFormBody> shape;
  std::optional<double> friction =
      0.3;  ///< Coulomb coefficient against every fabric; none: each fabric's friction_body
};

}  // namespace toile
