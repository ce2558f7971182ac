#pragma once
// The least net force that contacts and the friction of bending, both as they may, could leave.

#include "engine/quality/admissible_contact.h"

namespace toile {

/// What the friction of one bending stencil may do: forces arm · w on its nodes [N], for any w with |w| ≤ 1.
struct FrictionMoment {
  std::array<int, 6> nodes;
  Eigen::Matrix<double, 18, 3> arm;
};

/// As admissible_contact(), with the bending friction's moments among the unknowns: a place is an equilibrium if there
/// is a moment within each stencil's yield surface (|w| ≤ 1, terms/bending_law.h) and a force in each contact's cone
/// that balance all others. Whether a history leads to such moments is not asked.
///
/// Moments reach across the cloth, and going from stencil to stencil would take as many sweeps as the fourth power of
/// the edges across it. So it is solved by a barrier method: Newton's steps on the objective plus
/// τ (−Σ log(1 − |w|²) − Σ log(N² − |T|²/μ²)), whose linear systems are those of the vertices (Woodbury), with τ
/// falling until the gap to the least objective, at most 2τ a cone and τ a ball, is under a hundredth of it (or of 1e-6
/// a vertex). On which side a bilateral contact carries is taken
/// from admissible_contact(). Nodes that are held, have no mass, or lie beyond the list of masses take any force.
/// Deterministic; sequential.
AdmissibleContact admissible_forces(const std::vector<Contact>& contacts, const std::vector<FrictionMoment>& moments,
                                    const Positions& other_force, const std::vector<double>& mass,
                                    const std::vector<char>& held);

}  // namespace toile
