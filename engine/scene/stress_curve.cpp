#include "engine/scene/stress_curve.h"

#include <cmath>

namespace toile {
namespace {

/// Derivative at the outer end of the first of two intervals.
double end_tangent(double width, double next_width, double slope, double next_slope) {
  const double three_point = ((2 * width + next_width) * slope - width * next_slope) / (width + next_width);
  return std::clamp(three_point, 0.25 * slope, 3 * slope);
}

}  // namespace

StressCurve monotone_stress_curve(const std::vector<Vec2>& points, double additional) {
  StressCurve curve;
  curve.knots.push_back({});
  for (const Vec2& p : points) curve.knots.push_back({p.x(), 0, p.y(), 0, 0, 0});
  std::vector<StressCurve::Knot>& k = curve.knots;
  const std::size_t pieces = points.size();
  std::vector<double> width(pieces), slope(pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    width[i] = k[i + 1].strain - k[i].strain;
    slope[i] = (k[i + 1].stress - k[i].stress) / width[i];
  }
  if (pieces == 1) {
    k[0].tangent = k[1].tangent = slope[0];
  } else {
    k[0].tangent = end_tangent(width[0], width[1], slope[0], slope[1]);
    k[pieces].tangent = end_tangent(width[pieces - 1], width[pieces - 2], slope[pieces - 1], slope[pieces - 2]);
  }
  for (std::size_t i = 1; i < pieces; ++i) {
    const double before = 2 * width[i] + width[i - 1], after = width[i] + 2 * width[i - 1];
    k[i].tangent = (before + after) / (before / slope[i - 1] + after / slope[i]);
  }
  for (StressCurve::Knot& knot : k) {
    knot.stress += additional * knot.strain;
    knot.tangent += additional;
  }
  for (std::size_t i = 0; i < pieces; ++i) {
    const double secant = slope[i] + additional, h = width[i];
    k[i].quadratic = (3 * secant - 2 * k[i].tangent - k[i + 1].tangent) / h;
    k[i].cubic = (k[i].tangent + k[i + 1].tangent - 2 * secant) / (h * h);
    k[i + 1].energy =
        k[i].energy + h * (k[i].stress + h * (k[i].tangent / 2 + h * (k[i].quadratic / 3 + h * k[i].cubic / 4)));
  }
  return curve;
}

double StressCurve::least_tangent() const {
  double least = knots.back().tangent;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Knot& k = knots[i];
    least = std::min(least, k.tangent);
    if (!(k.cubic > 0)) continue;  // the tangent has no minimum between the knots
    const double d = -k.quadratic / (3 * k.cubic);
    if (d > 0 && d < knots[i + 1].strain - k.strain) least = std::min(least, at(k.strain + d).tangent);
  }
  return least;
}

}  // namespace toile
