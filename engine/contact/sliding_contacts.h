#pragma once
// Contacts of vertices that are attached to the body's surface and may slide along it.

#include "engine/contact/body_contacts.h"
#include "engine/geometry/body_field.h"

#include <vector>

namespace toile {

/// A waistband on its body, a strap on a shoulder: the vertex stays at the surface, from either side of it.
struct SlidingVertex {
  int vertex;
  double friction;  ///< Coulomb coefficient, under pull as under push
};

/// One bilateral contact (Contact::bilateral) a sliding vertex, at its offset from the surface however far it is now;
/// and takes the vertex's one-sided contact, which it replaces, out of `contacts` (those of body_contacts()).
void add_sliding_contacts(const std::vector<SlidingVertex>& sliding, const CollisionMesh& mesh, const BodyField& body,
                          const Positions& x, const BodyContactOptions& options, std::vector<Contact>& contacts);

}  // namespace toile
