#pragma once
// Cuts off what hangs from above: arms and hands of a body that stands with its arms down.

#include "engine/geometry/distance_grid.h"

#include <optional>

namespace toile {

/// Of the coarse grid's nodes inside, those that no path from the lowest 50 mm reaches by steps sideways or up are
/// hanging. Groups of them at least 100 mm tall are cut off, level at the height where they join the rest; lower ones
/// (a chin, a heel) stay. Nothing when nothing is cut. The result's triangles are cut to half a fine cell and closed by
/// the cut's plane; its `inside` refers to the grid by value and outlives both arguments.
std::optional<SoupSolid> cut_overhangs(const SoupSolid& solid, const DistanceGrid& grid);

}  // namespace toile
