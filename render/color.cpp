#include "render/color.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

using Color = Eigen::Array3d;

Rgb quantized(const Color& srgb) {
  Rgb rgb;
  for (int i = 0; i < 3; ++i) rgb[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(srgb[i], 0.0, 1.0)));
  return rgb;
}

// CIELAB (D65) to sRGB code values.
Color srgb_from_lab(const Color& lab) {
  const auto inverse = [](double f) { return f > 6.0 / 29 ? f * f * f : 3 * 36.0 / 841 * (f - 4.0 / 29); };
  const double fy = (lab[0] + 16) / 116;
  const double x = 0.95047 * inverse(fy + lab[1] / 500), y = inverse(fy), z = 1.08883 * inverse(fy - lab[2] / 200);
  const Color linear{3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                     0.0557 * x - 0.2040 * y + 1.0570 * z};
  return linear.unaryExpr([](double c) { return srgb_from_linear(std::clamp(c, 0.0, 1.0)); });
}

}  // namespace

double linear_from_srgb(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

double srgb_from_linear(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

Rgb cool_warm(double t) {
  // Msh (magnitude, saturation, hue) of the ends and of the middle; the middle's hue is each side's own spin.
  const double magnitude_end = 80, saturation_end = 1.08, magnitude_mid = 88;
  const double hue_cool = -1.1, hue_warm = 0.5, hue_mid_cool = -1.661, hue_mid_warm = 1.061;
  const double a = std::min(std::abs(t), 1.0);
  const double magnitude = std::lerp(magnitude_mid, magnitude_end, a), saturation = saturation_end * a;
  const double hue = t < 0 ? std::lerp(hue_mid_cool, hue_cool, a) : std::lerp(hue_mid_warm, hue_warm, a);
  return quantized(srgb_from_lab({magnitude * std::cos(saturation), magnitude * std::sin(saturation) * std::cos(hue),
                                  magnitude * std::sin(saturation) * std::sin(hue)}));
}

Rgb viridis(double t) {
  const Color coefficients[] = {
      {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
      {0.1050930431085774, 1.404613529898575, 1.384590162594685},
      {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
      {-4.634230498983486, -5.799100973351585, -19.33244095627987},
      {6.228269936347081, 14.17993336680509, 56.69055260068105},
      {4.776384997670288, -13.74514537774601, -65.35303263337234},
      {-5.435455855934631, 4.645852612178535, 26.3123352495832},
  };
  const double x = std::clamp(t, 0.0, 1.0);
  Color sum = Color::Zero();
  for (int i = 6; i >= 0; --i) sum = sum * x + coefficients[i];
  return quantized(sum);
}

}  // namespace toile
