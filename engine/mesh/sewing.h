#pragma once
// Joining the panels of a cloth along its seam pairs.

#include "engine/mesh/cloth.h"

#include <vector>

namespace toile {

/// Per vertex of a cloth that is still apart, the index of its panel; -1 for a vertex in no triangle.
std::vector<int> panel_of_vertices(const Cloth& apart);

/// Per vertex, the smallest vertex that seams join it to (itself where it is in no seam). The cloth is unchanged.
std::vector<int> seam_representatives(const Cloth& cloth);

/// Largest distance between the two vertices of a seam pair [m]; 0 without pairs.
double seam_gap_max(const Cloth& cloth);

/// Makes one vertex of each set that seam pairs join, at the mean of the set's positions; renumbers in order of first
/// occurrence, remaps triangles and labels, empties seam_pairs. Triangles whose corners become one, and two that come
/// to have the same three corners (the tip of a pleat), are dropped with a warning, and so are vertices that have no
/// other. Returns the new index of each old vertex, -1 for a dropped one.
std::vector<int> merge_seams(Cloth& cloth);

/// The same of the pairs alone whose vertices are no farther apart than `gap` [m]; the others stay in seam_pairs.
std::vector<int> merge_closed_seams(Cloth& cloth, double gap);

}  // namespace toile
