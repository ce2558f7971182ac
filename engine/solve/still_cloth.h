#pragma once
// Forces and energies of a cloth that is given, not simulated: every velocity is zero, friction is unknown.

#include "engine/contact/contact.h"
#include "engine/quality/admissible_forces.h"
#include "engine/solve/simulate.h"

namespace toile {

struct StillCloth {
  std::vector<double> mass;              ///< lumped [kg]
  std::vector<Contact> contacts;         ///< without friction; those of the cloth with itself first, …
  std::size_t cloth_contacts = 0;        ///< … so many of them
  std::vector<double> contact_distance;  ///< per vertex, where cloth repels cloth [m]
  Positions force;                       ///< of all but contacts, gravity included [N]
  std::vector<TermEnergy> energies;
  bool trims_rest = true;                        ///< whether rigid trims found a place at which they are at rest
  std::vector<FrictionMoment> friction_moments;  ///< of bending; their nodes may lie beyond the cloth's (clamps')
};

/// Rigid trims, whose places a mesh does not tell, are where their threads, weight and frictionless contacts leave them
/// at rest on the cloth as it is.
/// Of a sewn cloth at its positions, with the terms, options and body of a simulation. `start`: where its vertices were
/// at the start of the drape, whose planes clamps hold (solve/clamps.h), where key frames leave them. The friction of
/// bending is not among the forces, since positions do not tell how the cloth was bent before: what it may do is in
/// friction_moments.
StillCloth still_cloth(const Cloth& cloth, const Positions& start, const SimulationScene& scene);

}  // namespace toile
