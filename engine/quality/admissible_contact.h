#pragma once
// The least net force that contacts which press and rub as they may could leave: equilibrium judged without knowing how
// the cloth came to where it is.

#include "engine/contact/contact.h"
#include "engine/types.h"

#include <span>
#include <vector>

namespace toile {

struct AdmissibleContact {
  Positions net_force;      ///< what is left on each vertex [N]; zero on held ones
  Positions contact_force;  ///< of each contact, at its point p [N]
};

/// Static admissibility [Moreau's formulation of Coulomb friction]: a place is an equilibrium if there is a force in
/// each contact's Coulomb cone, N ≥ 0, |T| ≤ μN (a bilateral one may pull: |T| ≤ μ|N|), that balances all others. Given
/// the other forces F, finds the contact forces f that make
///   ½ Σ_v |F_v + Σ_c w_cv f_c|² / (m_v g)²
/// least over free vertices, the square of what measure_residual() reports: projected block Gauss–Seidel, one contact
/// at a time, each solved exactly (its block of the Hessian is a multiple of the identity). The problem is convex but
/// for bilateral contacts; the sweeps fall monotonically; they end when fifty of them gain less than a thousandth, or
/// after 1000. Where the contact's distance ends does not matter, so cloth of a program with another contact law is
/// judged alike, as long as its contacts are in the list. `held` and massless vertices take any force. Deterministic;
/// sequential.
AdmissibleContact admissible_contact(const std::vector<Contact>& contacts, const Positions& other_force,
                                     const std::vector<double>& mass, const std::vector<char>& held);

struct ContactCount {
  long pressing = 0;  ///< contacts with a normal force, bilateral ones that pull, too
  long sticking = 0;  ///< of these, with friction strictly inside the Coulomb cone
};
/// Of contacts with these forces; the lists are as long as each other.
ContactCount count_contacts(std::span<const Contact> contacts, std::span<const Vec3> force);

}  // namespace toile
