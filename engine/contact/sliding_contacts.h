#pragma once
// Contacts of vertices that are attached to the body's surface and may slide along it.

#include "engine/contact/contact.h"
#include "engine/geometry/body_field.h"

#include <vector>

namespace toile {

/// A waistband on its body, a strap on a shoulder: the vertex stays at the surface, from either side of it.
struct SlidingVertex {
  int vertex;
  double friction;  ///< Coulomb coefficient, under pull as under push
};

/// One bilateral contact (Contact::bilateral) a sliding vertex, at `offset` [m] from the surface however far it is now;
/// and takes the vertex's one-sided contact, which it replaces, out of `contacts` (those of body_contacts()).
void add_sliding_contacts(const std::vector<SlidingVertex>& sliding, const BodyField& body, const Positions& x,
                          double offset, std::vector<Contact>& contacts);

}  // namespace toile
