#pragma once
// What is sewn onto the garments of a scene, resolved to the vertices of the sewn cloth.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"
#include "engine/terms/drawcord.h"
#include "engine/terms/elastic.h"

#include <vector>

namespace toile {

struct Trimmings {
  std::vector<ElasticStencil> elastics;
  std::vector<DrawcordStencil> drawcords;
};

/// Throws InputError (`selects_no_edge`) where an elastic or a drawcord selects nothing of the sewn cloth.
Trimmings make_trimmings(const Scene& scene, const Cloth& sewn);

}  // namespace toile
