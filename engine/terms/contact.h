#pragma once
// Repulsion and Coulomb friction of one frozen contact (engine/contact/contact.h).

#include "engine/contact/contact.h"
#include "engine/terms/stencil.h"

namespace toile {

/// All of a contact's mechanics happens at p(x) = Σ wᵢ xᵢ: node i feels wᵢ f(p), and the Hessian's block (i, j) is
/// wᵢ wⱼ H(p). With unit normal n, stiffness k [N/m], depth d = distance − gap(p):
///   repulsion   E = ½ k max(0, d)²,  normal force N = k max(0, d)   [point repulsion, the first seed's §3.2];
///               Between layers, below d = ½ distance, it goes on as a logarithm that no load can close: E = ¼ k
///               distance² (½ − ln(2 gap/distance)), N = ¼ k distance²/gap, twice differentiable where they meet
///               [Offset Geometric Contact, SIGGRAPH 2025, §3.3]; nearer than distance/1000, which only trial states of
///               the line search reach, N grows linearly, so that it is finite everywhere.
///               Beyond the surface of a body (gap < 0 < distance) it goes on five times as stiff: seams that are tight
///               over an edge of a limb pull with newtons, too.
///   friction    u = (I − n nᵀ)(p − anchor), an elastic–plastic spring: force −k u while k |u| ≤ μ N (sticks, with the
///               energy ½ k |u|²), else −μ N u/|u| (slides)   [Coulomb; anchored springs after Yamane & Nakamura 2006].
/// A bilateral contact has d of either sign, E = ½ k d² and N = k |d|.
/// N is the one at p, not that of the step's start: at a solution the cone condition holds exactly and a resting
/// contact does not creep. The Hessian is positive semi-definite: K n nᵀ + k T while sticking, K n nᵀ + (μ N/|u|)(T − û
/// ûᵀ) while sliding, K = −dN/dgap; the coupling −μ K û (−nᵀ) of friction to the normal force is not symmetric and is
/// left out (Newton then converges linearly there).
struct ContactResponse {
  Vec3 force = Vec3::Zero();    ///< f(p) [N]
  Mat3 hessian = Mat3::Zero();  ///< H(p) [N/m]
  double normal_force = 0;      ///< N [N], not negative
  bool sliding = false;
};

/// p(x)
Vec3 contact_point(const Contact& c, const Positions& x);
/// gap(x) [m]
double contact_gap(const Contact& c, const Positions& x);

/// What a contact stores [J]: in repulsion, and in the tangential spring, at most as much as at the cone.
struct StoredEnergy {
  double repulsion = 0, friction = 0;
};
StoredEnergy stored_energy(const Contact& c, double stiffness, const Vec3& p);

/// Repulsion's energy [J] and, while the contact sticks, the tangential spring's; a sliding contact counts the spring's
/// energy at the cone (½ (μN)²/k) plus μN times the distance beyond it, whose gradient at fixed N is the force.
double contact_energy(const Contact& c, double stiffness, const Vec3& p);
ContactResponse contact_response(const Contact& c, double stiffness, const Vec3& p);

/// To be called with the state after an accepted step: a contact that slid drags its anchor along so that the spring is
/// exactly at the cone; one that is open (N = 0) forgets its anchor. Frictional history lives in the anchors alone.
void advance_anchor(Contact& c, double stiffness, const Positions& x);
void advance_anchors(std::vector<Contact>& contacts, double stiffness, const Positions& x);

}  // namespace toile
