#pragma once
// Puts the panels of sleeves where an arm can be inside them once they are sewn.

#include "engine/mesh/cloth.h"
#include "engine/solve/assemble.h"

#include <string>
#include <vector>

namespace toile {

/// Moves every panel whose `part` is "arm" across the arm, in its own plane, until the arm runs through its middle:
/// patterns place sleeves by their shoulder end, which leaves a wide cuff with the wrist at its edge, and sewn from
/// there, the seam slips off the wrist or cuts through it. Does nothing without a body that has hanging parts.
void center_sleeves(Cloth& apart, const std::vector<std::string>& part, const BodyFields& fields);

/// Rolls panels that are sewn to themselves along two far sides (a sleeve or a leg in one piece) round the limb behind
/// them, without stretching them: drawn together flat, their sides would meet without the limb between them. A panel
/// stays flat where nothing lies behind it or where it would not be free of the body. A rolled panel gets a `part` of
/// its own, since it is a tube before it is joined to others.
void roll_tubes(Cloth& apart, std::vector<std::string>& part, const BodyFields& fields);

}  // namespace toile
