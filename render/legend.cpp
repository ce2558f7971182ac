#include "render/legend.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/color.h"
#include "render/stroke_font.h"

namespace toile {
namespace {

constexpr Rgb kInk{48, 50, 54};
constexpr double kScalePercentile = 0.99;
constexpr int kTicks = 4;              // intervals between labels
constexpr double kStrokeWidth = 0.13;  // of a capital's height

// 1, 2 or 5 times a power of ten, at or above value.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= value * (1 - 1e-9)) return step * power;
  return 10 * power;
}

double percentile_of_magnitude(std::span<const double> values) {
  std::vector<double> magnitudes(values.size());
  std::transform(values.begin(), values.end(), magnitudes.begin(), [](double value) { return std::abs(value); });
  if (magnitudes.empty()) return 0;
  const auto at = magnitudes.begin() + static_cast<std::ptrdiff_t>(kScalePercentile * double(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), at, magnitudes.end());
  return *at;
}

std::string label(double value, bool with_sign) {
  char text[32];
  std::snprintf(text, sizeof text, with_sign && value > 0 ? "%+.4g" : "%.4g", value);
  return text;
}

class Canvas {
 public:
  Canvas(std::vector<std::uint8_t>& rgb, int width, int height) : rgb_(rgb), width_(width), height_(height) {}

  void blend(int x, int y, const Rgb& color, double cover) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || cover <= 0) return;
    std::uint8_t* pixel = &rgb_[3 * (std::size_t(y) * width_ + x)];
    for (int i = 0; i < 3; ++i)
      pixel[i] = static_cast<std::uint8_t>(std::lround(std::lerp(pixel[i], color[i], std::min(cover, 1.0))));
  }

  /// A text whose base line starts at (x, y), capitals `capital` px high. Anti-aliased by the distance to the strokes.
  void text(std::string_view words, double x, double y, double capital) {
    const StrokedText stroked = stroke_text(words);
    const double scale = capital / kCapitalHeight, radius = std::max(0.5, 0.5 * kStrokeWidth * capital);
    const int x0 = int(x - 2), x1 = int(x + stroked.width * scale + 3);
    const int y0 = int(y - 1.3 * capital), y1 = int(y + 0.4 * capital + 2);
    for (int py = y0; py <= y1; ++py)
      for (int px = x0; px <= x1; ++px) {
        const Vec2 at((px + 0.5 - x) / scale, (y - py - 0.5) / scale);
        blend(px, py, kInk, radius - distance(at, stroked) * scale + 0.5);
      }
  }

 private:
  static double distance(const Vec2& at, const StrokedText& text) {
    double nearest = 1e30;
    for (const std::vector<Vec2>& stroke : text.strokes)
      for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
        const Vec2 along = stroke[i + 1] - stroke[i], to = at - stroke[i];
        const double t = std::clamp(to.dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
        nearest = std::min(nearest, (to - t * along).squaredNorm());
      }
    return std::sqrt(nearest);
  }

  std::vector<std::uint8_t>& rgb_;
  int width_, height_;
};

}  // namespace

Rgb ColorScale::color(double position) const { return diverging ? cool_warm(2 * position - 1) : viridis(position); }

ColorScale color_scale(Overlay overlay, std::span<const double> values, double scale_max) {
  const double smallest = overlay == Overlay::stretch ? 0.01 : 1e-5;  // 1 %, 10 µN: no scale for rounding errors
  const double wanted = scale_max > 0 ? scale_max : round_up(std::max(smallest, percentile_of_magnitude(values)));
  if (overlay == Overlay::stretch) return {-wanted, wanted, true, 0.01, "stretch, %"};
  if (wanted < 0.5) return {0, wanted, false, 1e-3, "contact force, mN"};
  return {0, wanted, false, 1, "contact force, N"};
}

int legend_width(int width, int height) { return static_cast<int>(0.17 * std::min(width, height)); }

void draw_legend(const ColorScale& scale, std::vector<std::uint8_t>& rgb, int width, int height) {
  const double base = std::min(width, height), capital = 0.0155 * base, right = width - 0.035 * base;
  Canvas canvas(rgb, width, height);
  const double title_width = stroke_text(scale.title).width * capital / kCapitalHeight;
  const int top = int(0.5 * height - 0.27 * base), bottom = int(0.5 * height + 0.27 * base);
  const int bar_left = int(width - 0.130 * base), bar_right = int(width - 0.100 * base);
  canvas.text(scale.title, right - title_width, top - 2.2 * capital, capital);
  const int frame = std::max(1, int(0.001 * base));
  for (int y = top - frame; y < bottom + frame; ++y)
    for (int x = bar_left - frame; x < bar_right + frame; ++x) {
      const bool inside = x >= bar_left && x < bar_right && y >= top && y < bottom;
      canvas.blend(x, y, inside ? scale.color(1 - (y + 0.5 - top) / (bottom - top)) : kInk, 1);
    }
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double position = double(tick) / kTicks, value = std::lerp(scale.low, scale.high, position) / scale.unit;
    const double y = bottom - position * (bottom - top);
    for (int thick = 0; thick < frame; ++thick)
      for (int x = 0; x < int(0.008 * base); ++x) canvas.blend(bar_right + frame + x, int(y) - thick, kInk, 1);
    const std::string words = label(value, scale.diverging);
    canvas.text(words, bar_right + 0.018 * base, y + 0.5 * capital, capital);
  }
}

}  // namespace toile
