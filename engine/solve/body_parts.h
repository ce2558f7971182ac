#pragma once
// Which part of the body a panel is for.

#include "engine/mesh/cloth.h"
#include "engine/solve/assemble.h"

#include <string>
#include <vector>

namespace toile {

/// Per panel its pattern's label; where a garment's pattern labels no panel "arm", a panel most of which lies nearest
/// to a part of the body that hangs from above is "arm", too.
std::vector<std::string> part_of_panels(const Cloth& apart, const BodyFields& fields);

/// The points of the body's surface on parts that hang from above (arms, hands); empty without such.
Positions hanging_points(const BodyFields& fields);

}  // namespace toile
