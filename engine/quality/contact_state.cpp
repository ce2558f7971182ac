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
    state.repulsion_energy += 0.5 * response.normal_force * response.normal_force / stiffness;
    const double friction_force = (response.force - response.normal_force * c.normal).norm();
    state.friction_energy += 0.5 * friction_force * friction_force / stiffness;
  }
  return state;
}

}  // namespace toile
