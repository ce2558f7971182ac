#pragma once
// Closed polygons in the plane: points in order, the last joined to the first.

#include "engine/types.h"

#include <optional>
#include <utility>
#include <vector>

namespace toile {

/// Positive for counter-clockwise [unit of the points, squared].
double polygon_area(const std::vector<Vec2>& points);

/// The two segments (i: from point i to i + 1, the lower first) of one crossing or touching of the outline with itself,
/// if there is one; neighbours count when they fold back onto each other. O(n log n) for outlines met in practice.
std::optional<std::pair<int, int>> first_crossing(const std::vector<Vec2>& points);

}  // namespace toile
