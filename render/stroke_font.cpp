#include "render/stroke_font.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace toile {
namespace {

struct Glyph {
  char character;
  double width;
  /// "l x y x y …;" is a polyline, "a cx cy rx ry from to;" an elliptic arc between two angles in degrees.
  const char* strokes;
};

constexpr double kGap = 1.25;    // between characters
constexpr double kSpace = 2.0;   // a blank's width
constexpr double kArcStep = 12;  // degrees a segment

constexpr Glyph kGlyphs[] = {
    {'0', 4.0, "a 2 3 2 3 0 360"},
    {'1', 2.6, "l 0.6 4.8 2.2 6 2.2 0"},
    {'2', 4.0, "a 2 4.2 1.8 1.8 165 -35; l 3.47 3.17 0.2 0 4 0"},
    {'3', 3.8, "a 1.9 4.5 1.5 1.5 155 -90; a 1.9 1.5 1.8 1.5 90 -155"},
    {'4', 4.0, "l 3 0 3 6 0.1 1.7 4.1 1.7"},
    {'5', 3.8, "l 3.5 6 0.8 6 0.46 3.28; a 1.9 1.95 1.9 1.95 137 -150"},
    {'6', 3.9, "a 2 1.9 1.8 1.9 0 360; a 3.6 1.9 3.4 4.1 180 100"},
    {'7', 4.0, "l 0.1 6 3.9 6 1.4 0"},
    {'8', 3.8, "a 1.9 4.5 1.5 1.5 0 360; a 1.9 1.5 1.8 1.5 0 360"},
    {'9', 3.9, "a 1.9 4.1 1.8 1.9 0 360; a 0.3 4.1 3.4 4.1 0 -80"},
    {'%', 5.4, "a 1.1 4.8 1.1 1.2 0 360; a 4.3 1.2 1.1 1.2 0 360; l 4.4 6 1 0"},
    {'.', 0.4, "l 0.2 0 0.2 0.15"},
    {',', 0.6, "l 0.4 0.2 0 -1.1"},
    {'-', 2.8, "l 0.2 2.6 2.6 2.6"},
    {'+', 3.4, "l 0 2.6 3.4 2.6; l 1.7 0.9 1.7 4.3"},
    {'N', 4.2, "l 0 0 0 6 4.2 0 4.2 6"},
    {'a', 3.6, "a 1.8 2 1.8 2 0 360; l 3.6 4 3.6 0"},
    {'c', 3.0, "a 1.9 2 1.9 2 52 308"},
    {'e', 3.7, "l 0 2.1 3.68 2.1; a 1.85 2 1.85 2 3 312"},
    {'f', 2.4, "l 1 0 1 4.7; a 2.2 4.7 1.2 1.3 180 70; l 0 3.8 2.3 3.8"},
    {'h', 3.2, "l 0 0 0 6; a 1.6 2.4 1.6 1.6 180 0; l 3.2 2.4 3.2 0"},
    {'m', 5.4,
     "l 0 0 0 4; a 1.35 2.65 1.35 1.35 180 0; l 2.7 2.65 2.7 0; a 4.05 2.65 1.35 1.35 180 0; l 5.4 2.65 5.4 0"},
    {'n', 3.2, "l 0 0 0 4; a 1.6 2.4 1.6 1.6 180 0; l 3.2 2.4 3.2 0"},
    {'o', 3.8, "a 1.9 2 1.9 2 0 360"},
    {'r', 2.0, "l 0 0 0 4; a 1.7 2.1 1.7 1.9 180 80"},
    {'s', 3.0, "a 1.5 3 1.35 1 35 270; a 1.5 1 1.45 1 90 -145"},
    {'t', 2.3, "l 1 5.4 1 1.1; a 2 1.1 1 1.1 180 285; l 0 4 2.2 4"},
};

std::vector<Vec2> read_stroke(const std::string& text, double x) {
  std::istringstream in(text);
  char kind;
  in >> kind;
  std::vector<Vec2> points;
  if (kind == 'l') {
    for (double px, py; in >> px >> py;) points.emplace_back(x + px, py);
    return points;
  }
  double cx, cy, rx, ry, from, to;
  in >> cx >> cy >> rx >> ry >> from >> to;
  const int steps = std::max(2, int(std::ceil(std::abs(to - from) / kArcStep)));
  for (int i = 0; i <= steps; ++i) {
    const double angle = std::lerp(from, to, double(i) / steps) * std::numbers::pi / 180;
    points.emplace_back(x + cx + rx * std::cos(angle), cy + ry * std::sin(angle));
  }
  return points;
}

}  // namespace

StrokedText stroke_text(std::string_view text) {
  StrokedText result;
  double x = 0;
  for (const char character : text) {
    const auto glyph = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                    [&](const Glyph& candidate) { return candidate.character == character; });
    if (glyph == std::end(kGlyphs)) {
      x += kSpace;
      continue;
    }
    std::istringstream strokes(glyph->strokes);
    for (std::string stroke; std::getline(strokes, stroke, ';');) result.strokes.push_back(read_stroke(stroke, x));
    x += glyph->width + kGap;
  }
  result.width = std::max(0.0, x - kGap);
  return result;
}

}  // namespace toile
