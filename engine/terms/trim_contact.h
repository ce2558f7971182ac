#pragma once
// Repulsion and Coulomb friction of a rigid trim against cloth or body: one frozen contact.

#include "engine/contact/contact.h"
#include "engine/terms/contact.h"
#include "engine/terms/stencil.h"

namespace toile {

/// The law is that of terms/contact.h, over the point
///   p = Σ wᵢ xᵢ + σ (c + a),  a = R r,
/// with c the trim's centre, R its orientation and r a point of the trim's frame:
///   cloth against a trim: σ = −1, the weights sum to 1; r is where the cloth's point is, so that p is what cloth and
///   trim have moved past each other since detection, and forces and torques balance, friction's included, although
///   they act across a gap;
///   a trim against the body: σ = 1 and no cloth; r is a point of the trim's surface, p its place.
/// Up to five nodes, as in terms/attachment.h: three cloth vertices, the centre, and the rotation as ρ times its angle.
///   ∂p/∂(x₀, x₁, x₂, c, ρδ) = J = (w₀ I, w₁ I, w₂ I, σ I, −σ [a]×/ρ),
/// the nodes feel Jᵀ f(p), and the Hessian is Jᵀ H J − σ (½ (a fᵀ + f aᵀ) − (a·f) I)/ρ² in the block of the rotation;
/// the positive semi-definite one takes what is positive of the second part.
struct TrimContact {
  Contact contact;  ///< its nodes and weights are the cloth's: up to three, none for the body
  int trim = 0;
  double side = -1;           ///< σ
  Vec3 point = Vec3::Zero();  ///< r [m]
};

/// Where a contact is at a state.
struct TrimContactState {
  Vec3 lever;       ///< a [m]
  Vec3 point;       ///< p [m]
  double gyration;  ///< ρ [m]
};
/// `cloth`: the cloth's points, of which so many are read as the contact has nodes.
TrimContactState trim_contact_state(const TrimContact& c, const StencilPoints<3>& cloth, const Vec3& center,
                                    const Mat3& orientation, double gyration);

double trim_contact_energy(const TrimContact& c, double stiffness, const TrimContactState& at);
/// Minus the forces [N], on the rotation torque over ρ.
StencilVector<5> trim_contact_gradient(const TrimContact& c, double stiffness, const TrimContactState& at);
StencilMatrix<5> trim_contact_hessian(const TrimContact& c, double stiffness, const TrimContactState& at);
StencilMatrix<5> trim_contact_hessian_psd(const TrimContact& c, double stiffness, const TrimContactState& at);

/// The positive semi-definite Hessian in parts: Σ row rowᵀ, and `rotation` in the block of the rotation.
struct TrimContactResponse {
  StencilVector<5> force = StencilVector<5>::Zero();
  std::array<StencilVector<5>, 3> rows = {StencilVector<5>::Zero(), StencilVector<5>::Zero(), StencilVector<5>::Zero()};
  Mat3 rotation = Mat3::Zero();
};
TrimContactResponse trim_contact_response(const TrimContact& c, double stiffness, const TrimContactState& at);

}  // namespace toile
