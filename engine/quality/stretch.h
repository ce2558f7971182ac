#pragma once
// How much the fabric is stretched along warp, weft and bias.

#include "engine/report.h"
#include "engine/types.h"

#include <vector>

namespace toile {

/// Per triangle, stretch ratio minus one (0.02 = 2 % longer; negative: compressed), and the rest area [m²].
/// With F the deformation gradient from the flat pattern (u weft, v warp): weft |F e_u| − 1, warp |F e_v| − 1, bias the
/// larger of |F (e_u ± e_v)| / √2 − 1. A triangle of no rest area has 0 and area 0.
struct TriangleStretch {
  std::vector<double> warp, weft, bias, area;
  std::vector<double> smallest;  ///< the lesser principal stretch ratio minus one
};
TriangleStretch triangle_stretch(const std::vector<std::array<Vec2, 3>>& flat, const std::vector<Triangle>& triangles,
                                 const Positions& x);

/// Area-weighted mean, percentiles (the least value that so much of the area does not exceed), least and largest value.
/// Sizes must match; all 0 without area.
StretchStatistics stretch_statistics(const std::vector<double>& stretch, const std::vector<double>& area);

}  // namespace toile
