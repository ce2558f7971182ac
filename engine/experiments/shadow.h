#pragma once
// The shadow that a draped disc throws straight down, as the Cusick tester cuts it out of paper.

#include "engine/types.h"

#include <vector>

namespace toile {

/// Area [m²] of the triangles' projection along y beyond `radius` [m] around the y axis; where folds lie over one
/// another it counts once. Sampled at the centres of square pixels of 0.2 mm: of a disc of 30 cm it is right to 1e-4.
double shadow_area_beyond(double radius, const Positions& x, const std::vector<Triangle>& triangles);

/// Distance of the shadow's outline from the y axis [m] in `count` directions, evenly spaced from +x towards −z
/// (turning left as seen from above): the farthest crossing of an edge with the ray, at least `radius`.
std::vector<double> shadow_outline(double radius, const Positions& x, const std::vector<Triangle>& triangles,
                                   int count);

/// Amplitudes [m] of cos kφ and sin kφ together, k = 0 (the mean) to `highest`, of a function at evenly spaced angles.
std::vector<double> harmonics(const std::vector<double>& outline, int highest);

/// How many nodes (folds) a drape has: maxima of the outline that stand at least `prominence` [m] over the lowest point
/// on both sides before a higher one. A circle has none.
int node_count(const std::vector<double>& outline, double prominence);

}  // namespace toile
