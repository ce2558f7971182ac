#pragma once
// A standing body whose feet point straight down, as one points them to get into trousers.

#include "engine/geometry/solid.h"

namespace toile {

/// Below `ankle` [m], a height, the solid goes on straight down as it is there, without end; above, it is the whole
/// one. Distances below are those at the ankle: of the right sign, and never more than to the surface. `whole` is kept.
std::shared_ptr<const Solid> with_pointed_toes(std::shared_ptr<const Solid> whole, double ankle);

}  // namespace toile
