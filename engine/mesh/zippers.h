#pragma once
// A zipper in the mesh: which pairs of vertices it sews to each other, and the two runs that its tapes follow.

#include "engine/mesh/cloth.h"
#include "engine/scene/zipper.h"

#include <array>
#include <string>
#include <vector>

namespace toile {

/// Adds the zipper number `index` of a garment: the runs of its sides from the bottom up, as labels, and the seam pairs
/// from the bottom up to the slider: round(closed_fraction · segments) of them, or none where that is 0. Both runs are
/// as long as each other.
void add_zipper(const Zipper& zipper, std::size_t index, int garment, const std::array<std::vector<int>, 2>& sides,
                Cloth& cloth);

/// The runs as the cloth numbers them now: where the zipper is closed, one vertex is in both after sewing. Empty for a
/// zipper that the cloth does not have.
std::array<std::vector<int>, 2> zipper_sides(const Cloth& cloth, int garment, std::size_t index);

}  // namespace toile
