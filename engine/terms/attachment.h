#pragma once
// A spring between a point of a rigid trim and a point of the cloth (the first seed's §3.2: trims are rigid bodies with
// spring attachments to the fabric).

#include "engine/terms/stencil.h"

namespace toile {

/// With c the trim's centre, R its orientation and r the point in the trim's frame, a = R r:
///   d = c + a − Σ wᵢ xᵢ,  E = ½ k |d|² [J]: a spring of no length at rest.
/// Five nodes: three cloth vertices, the centre, and the rotation, whose unknown is the increment δ in
/// R ← exp([δ]×) R, times the length ρ of the trim (RigidBody::gyration), so that all unknowns are lengths. About δ =
/// 0:
///   ∂d/∂(x₀, x₁, x₂, c, ρδ) = J = (−w₀ I, −w₁ I, −w₂ I, I, −[a]×/ρ),
///   ∂E = k Jᵀ d,  ∂²E = k JᵀJ + k (½ (a dᵀ + d aᵀ) − (a·d) I)/ρ² in the block of the rotation.
/// The second part is that of a lever under load; the positive semi-definite Hessian takes what is positive of it.
/// Dissipation [W]: R = ½ β k |ḋ|², ḋ = J (velocities), rotational velocity ρ ω.
struct AttachmentStencil {
  std::array<int, 3> cloth;
  std::array<double, 3> weights;  ///< barycentric, sum 1
  int trim;                       ///< index of the trim
  Vec3 point;                     ///< r [m]
  double stiffness;               ///< k [N/m]
  double damping;                 ///< β [s]
};

/// Where the two ends are, and how the rotation enters. x: three cloth points and the trim's centre.
struct AttachmentState {
  Vec3 lever;       ///< a [m]
  Vec3 stretch;     ///< d [m]
  double gyration;  ///< ρ [m]
};
AttachmentState attachment_state(const AttachmentStencil& s, const StencilPoints<4>& x, const Mat3& orientation,
                                 double gyration);

double attachment_energy(const AttachmentStencil& s, const AttachmentState& at);
StencilVector<5> attachment_gradient(const AttachmentStencil& s, const AttachmentState& at);
StencilMatrix<5> attachment_hessian(const AttachmentStencil& s, const AttachmentState& at);
StencilMatrix<5> attachment_hessian_psd(const AttachmentStencil& s, const AttachmentState& at);

/// R [W]; v: velocities of the nodes, the last one ρ ω.
double attachment_dissipation(const AttachmentStencil& s, const AttachmentState& at, const StencilPoints<5>& v);
StencilVector<5> attachment_dissipation_gradient(const AttachmentStencil& s, const AttachmentState& at,
                                                 const StencilPoints<5>& v);
/// Positive semi-definite.
StencilMatrix<5> attachment_dissipation_hessian(const AttachmentStencil& s, const AttachmentState& at);

}  // namespace toile
