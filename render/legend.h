#pragma once
// The scale of a coloured overlay: its range, its colours and the legend drawn into the finished picture.

#include <span>
#include <string>
#include <vector>

#include "render/picture.h"

namespace toile {

/// How a field's value becomes a colour: from `low` to `high`, linearly.
struct ColorScale {
  double low = 0, high = 1;
  bool diverging = false;  ///< cool_warm, low = −high; else viridis, low = 0
  double unit = 1;         ///< a label shows value / unit
  std::string title;       ///< "stretch, %"

  double position(double value) const { return (value - low) / (high - low); }  ///< 0 at low, 1 at high
  Rgb color(double position) const;
};

/// The scale of an overlay for these values; end at `scale_max`, or where that is 0 at the round number (1, 2 or 5
/// times a power of ten) at or above the 99th percentile of |value|.
ColorScale color_scale(Overlay overlay, std::span<const double> values, double scale_max);

/// Width [px] of the strip at the picture's right that a legend takes.
int legend_width(int width, int height);

/// Draws title, bar, ticks and labels over rgb (3·width·height bytes, top row first). Sizes grow with the picture.
void draw_legend(const ColorScale& scale, std::vector<std::uint8_t>& rgb, int width, int height);

}  // namespace toile
