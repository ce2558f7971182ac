#pragma once
// Flat panels come near the body before their seams close.

#include "engine/contact/collision_mesh.h"
#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"

#include <vector>

namespace toile {

/// Each flat panel of a garment moves along its normal towards what it is sewn to (the mean over its seams with other
/// panels), until a point of it is 30 mm from the body, or near other cloth, or it is there. Closing pulls at seams
/// alone, and that travels through a panel by a few edges a step: from afar, the rim of a panel runs ahead of its
/// middle, the finer the mesh the more, and arrives at another height than the pattern has it; a shoulder then is
/// caught below the arm. Panels that are folded or rolled, and those with held vertices, stay. `mesh`: with the seams'
/// zones; `field`, `held`: per vertex. Deterministic.
void approach(Cloth& apart, int garment, CollisionMesh mesh, const std::vector<const BodyField*>& field,
              const std::vector<char>& held);

}  // namespace toile
