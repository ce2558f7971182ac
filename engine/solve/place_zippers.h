#pragma once
// Zippers on the sewn cloth: tapes along both edges, and the rigid ends.

#include "engine/solve/trimmings.h"

namespace toile {

/// Adds to `trimmings`, for each zipper of the scene:
///   tapes: along the closed chain all of the zipper's mass, tension and bending, along each open side half of it;
///   the slider, where the closed part ends, on springs to the chain below it, to the cloth on both sides and to both
///   tapes above, which it holds apart by half its width; at the very top it sits on the chain, and of a zipper that is
///   open altogether on the first side's bottom;
///   a stop at the bottom (the second side's, where all is open), and one at the top of each side that is open.
/// All ends lie on the right side of the cloth, at the distance at which contact leaves it alone (trim_touching.h).
/// Throws InputError (`zipper_too_short`) where an end is longer than half the zipper, or does not fit onto the panel
/// beside it.
void place_zippers(const Scene& scene, const Cloth& sewn, Trimmings& trimmings);

}  // namespace toile
