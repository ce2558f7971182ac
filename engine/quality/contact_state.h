#pragma once
// What contacts and friction do in a final state.

#include "engine/contact/contact.h"
#include "engine/report.h"

#include <span>

namespace toile {

struct ContactState {
  long pressing = 0;            ///< contacts with a normal force
  long sticking = 0;            ///< of these, with friction inside the Coulomb cone; without friction there are none
  double repulsion_energy = 0;  ///< [J] (terms/contact.h)
  double friction_energy = 0;   ///< stored in the tangential springs, Σ ½ k min(|u|, μN/k)² [J]
};

/// Of frozen contacts at positions x, with the repulsion's stiffness k [N/m]. Anchors tell friction: contacts that are
/// detected anew have none.
ContactState contact_state(std::span<const Contact> contacts, double stiffness, const Positions& x);

}  // namespace toile
