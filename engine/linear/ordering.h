#pragma once
// An order of the nodes that keeps neighbours close in memory.

#include "engine/types.h"

namespace toile {

/// Reverse Cuthill–McKee over the graph of the triangles' edges [Cuthill & McKee 1969; the first seed's §6.4]. Element
/// i is the old index of new node i; a permutation of 0 … nodes − 1, deterministic.
std::vector<int> reverse_cuthill_mckee(int nodes, const std::vector<Triangle>& triangles);

/// inverse[order[i]] = i
std::vector<int> inverse_permutation(const std::vector<int>& order);

}  // namespace toile
