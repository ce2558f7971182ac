#include "engine/scene/stretch_test.h"

#include "engine/scene/problem.h"

#include <cmath>

namespace toile {
namespace {

/// The area under which a triangle resists collapse on top of its fabric (kCompressionOnset in terms/membrane.h), with
/// room for what a mesh adds.
constexpr double kLeastArea = 0.72;

std::string at(const std::string& pointer, const char* direction, std::size_t reading) {
  return pointer + "/" + direction + "/" + std::to_string(reading);
}

double green(double strain) { return strain * (1 + 0.5 * strain); }

/// (E, P/λ) of the readings.
std::vector<Vec2> stresses(const std::vector<ForceStrain>& readings, const std::string& pointer,
                           const char* direction) {
  std::vector<Vec2> points;
  ForceStrain last;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const ForceStrain& r = readings[i];
    if (!(std::isfinite(r.strain) && std::isfinite(r.force) && r.strain > last.strain && r.force > last.force))
      throw InputError(at(pointer, direction, i), "curve_not_rising",
                       "Strain and force must be greater than those of the reading before.");
    if (!(r.force / (1 + r.strain) > last.force / (1 + last.strain)))
      throw InputError(at(pointer, direction, i), "curve_not_rising",
                       "The force must grow faster than the strip's length from one reading to the next.");
    points.emplace_back(green(r.strain), r.force / (1 + r.strain));
    last = r;
  }
  return points;
}

/// Either a curve or a modulus.
struct Law {
  const StressCurve* curve;
  double modulus;
  StressCurve::Value value(double strain) const {
    return curve->empty() ? StressCurve::Value{modulus * strain, modulus} : curve->at(strain);
  }
  double least() const { return curve->empty() ? modulus : curve->least_tangent(); }
};

/// Strains of weft and warp that both carry `stress`: Newton's method on a convex energy, with halved steps where the
/// residual would grow.
Vec2 equal_stress(const Law& weft, const Law& warp, double coupling, double stress) {
  Vec2 e = Vec2::Zero();
  const auto residual = [&](const Vec2& strain) {
    return Vec2(weft.value(strain[0]).stress + coupling * strain[1] - stress,
                warp.value(strain[1]).stress + coupling * strain[0] - stress);
  };
  Vec2 r = residual(e);
  for (int k = 0; k < 200 && r.norm() > 1e-13 * stress; ++k) {
    const double a = weft.value(e[0]).tangent, b = warp.value(e[1]).tangent, det = a * b - coupling * coupling;
    Vec2 step = -Vec2(b * r[0] - coupling * r[1], a * r[1] - coupling * r[0]) / det;
    for (int halving = 0; halving < 60 && residual(e + step).norm() >= r.norm(); ++halving) step *= 0.5;
    e += step;
    r = residual(e);
  }
  return e;
}

/// A strip's area over its rest area at the last reading.
void require_room(const std::vector<ForceStrain>& readings, double narrowing, const std::string& pointer,
                  const char* direction) {
  if (readings.empty()) return;
  const double strain = readings.back().strain, lateral = 1 - 2 * narrowing * green(strain);
  if (!(lateral > 0 && (1 + strain) * std::sqrt(lateral) > kLeastArea))
    throw InputError(at(pointer, direction, readings.size() - 1), "poisson_too_large",
                     "At this elongation the Poisson ratio would close the strip's sides in too far; give a smaller "
                     "poisson_ratio.");
}

}  // namespace

void apply_stretch_test(const StretchTest& test, double poisson_ratio, const std::string& pointer, Fabric& fabric) {
  const std::vector<Vec2> warp = stresses(test.warp, pointer, "warp"), weft = stresses(test.weft, pointer, "weft");
  const double nu2 = poisson_ratio * poisson_ratio;
  const auto fit = [&](const std::vector<Vec2>& points, StressCurve& curve, double& modulus) {
    curve.knots.clear();
    if (points.empty()) return;
    modulus = monotone_stress_curve(points).initial_tangent() / (1 - nu2);
    curve = monotone_stress_curve(points, nu2 * modulus);
  };
  Directional& rest = fabric.stretch_stiffness;
  fit(warp, fabric.warp_stress, rest.warp);
  fit(weft, fabric.weft_stress, rest.weft);
  fabric.shear_stress.knots.clear();
  const double coupling = poisson_ratio * std::sqrt(rest.warp * rest.weft);
  fabric.poisson_stiffness = coupling;
  require_room(test.warp, coupling / rest.weft, pointer, "warp");
  require_room(test.weft, coupling / rest.warp, pointer, "weft");
  const Law along_warp{&fabric.warp_stress, rest.warp}, along_weft{&fabric.weft_stress, rest.weft};
  if (!(coupling * coupling < along_warp.least() * along_weft.least()))
    throw InputError(pointer, "curve_too_soft",
                     "A curve gets so much softer than at rest that the coupling by poisson_ratio outweighs it.");

  std::vector<Vec2> bias = stresses(test.bias, pointer, "bias");
  double last = 0;
  for (std::size_t i = 0; i < bias.size(); ++i) {
    const double stress = 0.5 * bias[i].y();
    const double shear = bias[i].x() - 0.5 * equal_stress(along_weft, along_warp, coupling, stress).sum();
    if (!(shear > last))
      throw InputError(at(pointer, "bias", i), "curve_too_stiff",
                       "Warp and weft alone already give way to this force by as much as the strip got longer.");
    bias[i] = {shear, stress};
    last = shear;
  }
  if (bias.empty()) return;
  fabric.shear_stress = monotone_stress_curve(bias);
  rest.bias = 0.5 * fabric.shear_stress.initial_tangent();
}

}  // namespace toile
