#pragma once
// Contacts of the cloth with the body's distance field.

#include "engine/contact/collision_mesh.h"
#include "engine/contact/contact.h"
#include "engine/geometry/body_field.h"

#include <vector>

namespace toile {

struct BodyContactOptions {
  double offset = 3e-3;   ///< vertices are repelled from the surface up to here [m]; 0: the mesh's body_offset
  double friction = 0.3;  ///< Coulomb coefficient; < 0: the mesh's friction table
};

/// How far a vertex is kept off the surface [m].
inline double offset_from_body(const CollisionMesh& mesh, const BodyContactOptions& options, int vertex) {
  return options.offset > 0 ? options.offset : mesh.body_offset[vertex];
}

/// Vertices nearer to the body than their offset; and midpoints of edges and triangles nearer than half of it (of the
/// smallest one), so that the chord of a coarse triangle does not cut into a finger or an armpit's fold. gap is the
/// distance field, linear about x. In a fold of the body (thighs that touch, a crotch), where surfaces over 35° apart
/// are within reach, there is a contact with each: the field tells the nearest alone, which changes from step to step
/// and would throw the cloth to and fro. Parallel, in a fixed order.
std::vector<Contact> body_contacts(const CollisionMesh& mesh, const BodyField& body, const Positions& x,
                                   const BodyContactOptions& options);

}  // namespace toile
