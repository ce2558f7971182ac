#pragma once
// Which part of the body a panel is for, and sleeves put where an arm can be inside them.

#include "engine/mesh/cloth.h"
#include "engine/solve/assemble.h"

#include <string>
#include <vector>

namespace toile {

/// Per panel its pattern's label; where a garment's pattern labels no panel "arm", a panel most of which lies nearest
/// to a part of the body that hangs from above is "arm", too.
std::vector<std::string> part_of_panels(const Cloth& cloth, int garment, const BodyFields& fields);

/// Moves every panel of an arm across the arm, in its own plane, until the arm runs through its middle. Patterns place
/// sleeves by their shoulder end, which leaves a wide cuff with the wrist at its edge: sewn from there, the seam slips
/// off the wrist or cuts through it. Does nothing without a body that has hanging parts.
void center_sleeves(Cloth& apart, const BodyFields& fields);

}  // namespace toile
