#pragma once
// Draws cloth that passes through itself back out, where no history says which side is right.

#include "engine/quality/intersections.h"
#include "engine/types.h"

#include <vector>

namespace toile {

/// Moves that shorten the curves in which the surface crosses itself: for every edge e of a triangle f that pierces a
/// triangle with normal N,
///   G = R − (e·R)/(e·N) N,   R the direction of the crossing line into f,
/// the edge goes along G and the pierced triangle against it, by barycentric weights, `step` [m] in all
/// (Volino and Magnenat-Thalmann, "Resolving surface collisions through intersection contour minimization", SIGGRAPH
/// 2006, §3). A vertex's move is the mean of what its crossings ask for. `triangles` indexes x; zero where nothing
/// crosses.
Positions untangling_moves(const Positions& x, const std::vector<Triangle>& triangles,
                           const std::vector<TrianglePair>& crossings, double step);

}  // namespace toile
