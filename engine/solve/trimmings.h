#pragma once
// What is sewn onto the garments of a scene, resolved to the vertices of the sewn cloth.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"
#include "engine/solve/rigid_body.h"
#include "engine/solve/trim_shape.h"
#include "engine/terms/attachment.h"
#include "engine/terms/drawcord.h"
#include "engine/terms/elastic.h"
#include "engine/terms/tape.h"

#include <vector>

namespace toile {

/// A trim of a scene where assembly puts it.
struct RigidTrim {
  RigidBody body;
  RigidState start;
  TrimShape shape = {};
  double friction = 0;  ///< Coulomb coefficient against cloth and body
};

/// What a trim adds to a vertex of the cloth.
struct AddedMass {
  int vertex;
  double mass;  ///< [kg]
};

struct Trimmings {
  std::vector<ElasticStencil> elastics;
  std::vector<DrawcordStencil> drawcords;
  std::vector<TapeStencil> tapes;
  std::vector<AddedMass> masses;
  std::vector<RigidTrim> trims;
  std::vector<AttachmentStencil> attachments;
};

/// Throws InputError: `selects_no_edge` where an elastic or a drawcord selects nothing of the sewn cloth, those of
/// place_trims.h and place_zippers.h.
Trimmings make_trimmings(const Scene& scene, const Cloth& sewn);

}  // namespace toile
