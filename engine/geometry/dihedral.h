#pragma once
// The signed dihedral angle of a hinge of two triangles, and its exact derivatives.

#include "engine/types.h"

namespace toile {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// Angle between the normals of the triangles (x0, x1, x2) and (x1, x0, x3), which share the edge x0 x1 [rad]:
///   θ = atan2( e·(N1 × N2), |e| N1·N2 ),  e = x1 − x0,  N1 = e × (x2 − x0),  N2 = (x3 − x0) × e.
/// In (−π, π], 0 where flat, positive where the hinge is a ridge seen from the side that the normals point to (a convex
/// surface with outward normals). Exact up to ±180°; Tamstorf & Grinspun 2013, "Discrete bending forces and their
/// Jacobians". A hinge with a triangle of no area has the angle 0 and derivatives 0.
double dihedral_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

/// ∂θ/∂(x0, x1, x2, x3) [1/m]:
///   ∂θ/∂x2 = −|e| N1/|N1|²,  ∂θ/∂x3 = −|e| N2/|N2|²,
///   ∂θ/∂x1 = −t1 ∂θ/∂x2 − t2 ∂θ/∂x3,  ∂θ/∂x0 = −(1 − t1) ∂θ/∂x2 − (1 − t2) ∂θ/∂x3,
/// with t1, t2 the feet of x2, x3 on the edge as fractions of it from x0.
Vec12 dihedral_angle_gradient(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

/// ∂²θ/∂x² [1/m²], exact and symmetric; indefinite.
Mat12 dihedral_angle_hessian(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

}  // namespace toile
