#pragma once
// Elastic sewn along edges of the cloth (waistbands, cuffs): tension in one dimension, segment by segment.

#include "engine/terms/stencil.h"

namespace toile {

/// Energy of a segment [J] between two neighbouring vertices, l their distance:
///   E = ½ k L ε²,  ε = max(0, l/L − 1);  tension T = k ε [N], nothing while slack: a band buckles, it does not push.
/// L is the length at which the elastic is relaxed: the edge's flat length times the share at which it was sewn in.
/// E is once continuously differentiable, its Hessian positive semi-definite everywhere (zero while slack).
/// Dissipation potential [W], Kelvin–Voigt with the fabric's kind of β: R = ½ β k L w ε̇², w = min(1, ε/ε₁), so that
/// the viscous force sets in with the elastic one and not with a jump. The position derivative of the dissipative force
/// is dropped.
struct ElasticStencil {
  std::array<int, 2> nodes;
  double rest_length;  ///< L [m], positive
  double stiffness;    ///< k [N] per strain
  double damping;      ///< β [s]
};

/// ε₁: the strain from which on tension is fully damped. A band of a metre takes 5 mm to get there.
inline constexpr double kFullyDampedStrain = 5e-3;

/// w(ε) as above, also for drawcords.
double tension_damping_share(double strain);

double elastic_energy(const ElasticStencil& s, const StencilPoints<2>& x);
StencilVector<2> elastic_gradient(const ElasticStencil& s, const StencilPoints<2>& x);
/// Exact, and positive semi-definite as it is.
StencilMatrix<2> elastic_hessian(const ElasticStencil& s, const StencilPoints<2>& x);

/// R [W]
double elastic_dissipation(const ElasticStencil& s, const StencilPoints<2>& x, const StencilPoints<2>& v);
/// ∂R/∂v [N] = minus the dissipative force.
StencilVector<2> elastic_dissipation_gradient(const ElasticStencil& s, const StencilPoints<2>& x,
                                              const StencilPoints<2>& v);
/// ∂²R/∂v² [N·s/m], positive semi-definite.
StencilMatrix<2> elastic_dissipation_hessian(const ElasticStencil& s, const StencilPoints<2>& x);

/// Force on the first node and the system's block H: the blocks are H on the diagonal and −H beside it, the force on
/// the second node is the negative. H = stiffness · _hessian + dissipation · _dissipation_hessian, times the factor.
struct ElasticResponse {
  Vec3 force = Vec3::Zero();
  Mat3 block = Mat3::Zero();
};
ElasticResponse elastic_response(const ElasticStencil& s, const StencilPoints<2>& x, const StencilPoints<2>& v,
                                 const SystemWeights& weights);

}  // namespace toile
