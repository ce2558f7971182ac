#pragma once
// How far two drapes are from each other.

#include "engine/types.h"

#include <vector>

namespace toile {

struct DrapeDistance {
  double mean = 0, max = 0;  ///< [m]
};

/// Vertex by vertex, of the same mesh in two positions. Throws std::invalid_argument for different counts.
DrapeDistance vertex_distance(const Positions& a, const Positions& b);

/// From surface to surface, of any two meshes: the distance of each vertex and each barycentre (weighted by the areas
/// around them) to the nearest point of the other surface, both ways; the mean of the two means, the larger maximum.
/// Both must have triangles, else std::invalid_argument.
DrapeDistance surface_distance(const Positions& a, const std::vector<Triangle>& triangles_a, const Positions& b,
                               const std::vector<Triangle>& triangles_b);

}  // namespace toile
