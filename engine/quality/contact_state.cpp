#include "engine/quality/contact_state.h"

#include "engine/quality/admissible_contact.h"
#include "engine/terms/contact.h"

#include <algorithm>

namespace toile {

ContactState contact_state(std::span<const Contact> contacts, double stiffness, const Positions& x) {
  ContactState state;
  std::vector<Vec3> forces;
  for (const Contact& c : contacts) {
    const Vec3 p = contact_point(c, x);
    const ContactResponse response = contact_response(c, stiffness, p);
    forces.push_back(response.force);
    if (!(response.normal_force > 0)) continue;
    const StoredEnergy stored = stored_energy(c, stiffness, p);
    state.repulsion_energy += stored.repulsion;
    state.friction_energy += stored.friction;
  }
  const ContactCount count = count_contacts(contacts, forces);
  state.pressing = count.pressing;
  state.sticking = count.sticking;
  return state;
}

}  // namespace toile
