#pragma once
// A small sans-serif font of strokes, for the legend: digits, % . , + - and the letters of its titles.

#include <string_view>
#include <vector>

#include "engine/types.h"

namespace toile {

/// A line of text as polylines in units of one sixth of a capital's height: x to the right from 0, y up from the
/// base line. Characters that the font lacks leave a gap.
struct StrokedText {
  std::vector<std::vector<Vec2>> strokes;
  double width = 0;
};
inline constexpr double kCapitalHeight = 6;

StrokedText stroke_text(std::string_view text);

}  // namespace toile
