#pragma once
// Colours: the sRGB transfer curve and the two colour maps of the overlays.

#include "render/picture.h"

namespace toile {

/// sRGB code value in [0, 1] to linear light and back (IEC 61966-2-1).
double linear_from_srgb(double code);
double srgb_from_linear(double light);

/// Diverging map blue – light grey – red for t in [−1, 1] (clamped): Moreland, "Diverging Color Maps for Scientific
/// Visualization", ISVC 2009, his cool–warm end points interpolated in Msh space. Equal steps look equal, and 0 is
/// grey.
Rgb cool_warm(double t);

/// Viridis (van der Walt and Smith, matplotlib 2015) for t in [0, 1] (clamped), as Zucker's polynomial fit of degree 6
/// (CC0), within 4 code values of the original.
Rgb viridis(double t);

}  // namespace toile
