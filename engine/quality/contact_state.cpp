#include "engine/quality/contact_state.h"

#include "engine/terms/contact.h"

#include <algorithm>

namespace toile {

ContactState contact_state(std::span<const Contact> contacts, double stiffness, const Positions& x) {
  ContactState state;
  for (const Contact& c : contacts) {
    const Vec3 p = contact_point(c, x);
    const ContactResponse response = contact_response(c, stiffness, p);
    if (!(response.normal_force > 0)) continue;
    ++state.pressing;
    if (c.friction > 0 && !response.sliding) ++state.sticking;
    const StoredEnergy stored = stored_energy(c, stiffness, p);
    state.repulsion_energy += stored.repulsion;
    state.friction_energy += stored.friction;
  }
  return state;
}

}  // namespace toile
