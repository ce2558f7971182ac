#include "engine/experiments/fabric_model.h"

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

using Kind = FitParameter::Kind;

constexpr double kLeastModulus = 0.1, kLeastShear = 0.01, kMostModulus = 1e6;  // [N/m]
constexpr double kLeastBending = 1e-9, kMostBending = 0.1;                     // [N·m]
constexpr double kFromStart =
    20;  // factor from a bending stiffness's start to its bounds: far stiffer strips come to rest late
constexpr double kLeastFactor = 0.05, kMostFactor = 3;
constexpr double kWeightlessLoop = 0.4243, kLimpLoop = 0.5;
constexpr double kHalfLimpWeight = 1300;  // areal density · g · length³ / D of a loop half way between those two

double poisson_ratio(const FabricMeasurements& m) {
  const Directional& c = m.base.stretch_stiffness;
  return m.poisson_ratio.value_or(m.base.poisson_stiffness / std::sqrt(c.warp * c.weft));
}

std::vector<ForceStrain>& readings(StretchTest& test, Direction direction) {
  return direction == Direction::warp ? test.warp : direction == Direction::weft ? test.weft : test.bias;
}

/// Of P = Y λ (λ² − 1)/2, the mean over the readings.
double free_modulus(const MeasuredPull& test) {
  double sum = 0;
  for (const ForceStrain& r : test.readings) {
    const double stretch = 1 + r.strain;
    sum += 2 * r.force / (stretch * (stretch * stretch - 1));
  }
  return sum / static_cast<double>(test.readings.size());
}

FitParameter modulus(Direction direction, double start) {
  const double low = direction == Direction::bias ? kLeastShear : kLeastModulus;
  return {Kind::modulus, direction, 0, std::clamp(start, 2 * low, 0.5 * kMostModulus), low, kMostModulus};
}

void add_curve(const MeasuredPull& test, Direction direction, std::vector<FitParameter>& parameters) {
  const double first = test.readings.front().strain, last = test.readings.back().strain;
  const auto add = [&](double strain) {
    parameters.push_back({Kind::curve_factor, direction, strain, 1, kLeastFactor, kMostFactor});
  };
  add(first);
  if (test.readings.size() > 2) add(0.5 * (first + last));
  add(last);
}

/// Of a curve at a strain: the logarithms of its parameters' values, linear between their strains.
double factor_at(double strain, Direction direction, const std::vector<FitParameter>& parameters,
                 const Numbers& values) {
  std::vector<Vec2> knots;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (parameters[k].kind == Kind::curve_factor && parameters[k].direction == direction)
      knots.emplace_back(parameters[k].strain, std::log(values[static_cast<Eigen::Index>(k)]));
  std::size_t k = 1;
  while (k + 1 < knots.size() && strain > knots[k].x()) ++k;
  const Vec2 from = knots[k - 1], to = knots[k];
  return std::exp(from.y() + (to.y() - from.y()) * (strain - from.x()) / (to.x() - from.x()));
}

Numbers starts(const std::vector<FitParameter>& parameters) {
  Numbers values(parameters.size());
  for (std::size_t k = 0; k < parameters.size(); ++k) values[static_cast<Eigen::Index>(k)] = parameters[k].start;
  return values;
}

/// Grips stiffen a bias strip, in the end beyond what warp and weft allow one with free sides: begins with softer ones
/// until a fabric can have them.
void soften_bias(const FabricMeasurements& m, std::vector<FitParameter>& parameters) {
  for (double factor = 1;; factor *= 0.85) {
    for (FitParameter& p : parameters)
      if (p.kind == Kind::curve_factor && p.direction == Direction::bias) p.start = factor;
    try {
      with_stretch(m, parameters, starts(parameters));
      return;
    } catch (const InputError& error) {
      if (factor < 0.3)
        throw InputError(
            "/bias_extension", error.problems().front().code,
            "No fabric of these warp and weft is as stiff on the bias: " + error.problems().front().detail);
    }
  }
}

/// By G = 1/(4/Y − S11 − S22 − 2 S12); as stiff as the strip where warp and weft alone give way too much.
double shear_of(double bias_modulus, const Fabric& fabric) {
  const Directional& c = fabric.stretch_stiffness;
  const double coupling = fabric.poisson_stiffness, determinant = c.warp * c.weft - coupling * coupling;
  const double compliance = 4 / bias_modulus - (c.warp + c.weft - 2 * coupling) / determinant;
  return compliance > 0 ? 1 / compliance : bias_modulus;
}

double start_of_bending(const FabricMeasurements& m, std::size_t d) {
  const double weight = m.area_density * kGravity;
  if (m.bending[d]) return m.bending[d]->value;
  if (m.cantilevers[d]) {
    const MeasuredCantilever& test = *m.cantilevers[d];
    const double load = weight * std::pow(test.overhang, 3);
    if (test.reading == MeasuredCantilever::Reading::angle)
      return load * std::cos(0.5 * test.value) / (8 * std::tan(test.value));
    const double share = std::min(test.value / test.overhang, 0.99);
    return load / (8 * share / std::sqrt(1 - share) + 0.37 * std::pow(share, 4) / std::pow(1 - share, 2));
  }
  const MeasuredLoop& test = *m.loops[d];
  const double share =
      std::clamp((test.height / test.length - kWeightlessLoop) / (kLimpLoop - kWeightlessLoop), 0.02, 0.95);
  return weight * std::pow(test.length, 3) * (1 - share) / (kHalfLimpWeight * share);
}

}  // namespace

FabricModel base_model(const FabricMeasurements& m) {
  FabricModel model{m.base, m.base_stretch};
  model.fabric.area_density = m.area_density;
  if (m.thickness) model.fabric.thickness = *m.thickness;
  return model;
}

std::vector<FitParameter> stretch_parameters(const FabricMeasurements& m) {
  std::vector<FitParameter> parameters;
  const double nu = poisson_ratio(m);
  bool bias_curve = false;
  for (std::size_t d = 0; d < m.pulls.size(); ++d) {
    if (!m.pulls[d]) continue;
    const auto direction = static_cast<Direction>(d);
    if (m.pulls[d]->as_curve) {
      add_curve(*m.pulls[d], direction, parameters);
      bias_curve = bias_curve || direction == Direction::bias;
    } else {
      const double free = free_modulus(*m.pulls[d]);
      const double start = direction == Direction::bias
                               ? shear_of(free, with_stretch(m, parameters, starts(parameters)).fabric)
                               : free / (1 - nu * nu);
      parameters.push_back(modulus(direction, start));
    }
  }
  if (m.shear && !m.pulls[static_cast<std::size_t>(Direction::bias)])
    parameters.push_back(modulus(Direction::bias, m.shear->value));
  if (bias_curve) soften_bias(m, parameters);
  return parameters;
}

FabricModel with_stretch(const FabricMeasurements& m, const std::vector<FitParameter>& parameters,
                         const Numbers& values) {
  FabricModel model = base_model(m);
  Directional& moduli = model.fabric.stretch_stiffness;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const FitParameter& p = parameters[k];
    std::vector<ForceStrain>& curve = readings(model.stretch, p.direction);
    curve.clear();
    if (p.kind == Kind::modulus) {
      along(moduli, p.direction) = values[static_cast<Eigen::Index>(k)];
      continue;
    }
    for (const ForceStrain& r : m.pulls[static_cast<std::size_t>(p.direction)]->readings)
      curve.push_back({r.strain, r.force * factor_at(r.strain, p.direction, parameters, values)});
  }
  apply_stretch_test(model.stretch, poisson_ratio(m), "", model.fabric);
  return model;
}

std::vector<FitParameter> bending_parameters(const FabricMeasurements& m) {
  std::vector<FitParameter> parameters;
  for (std::size_t d = 0; d < m.bending.size(); ++d) {
    if (!m.bending[d] && !m.cantilevers[d] && !m.loops[d]) continue;
    const double start = std::clamp(start_of_bending(m, d), 2 * kLeastBending, 0.5 * kMostBending);
    parameters.push_back({Kind::bending, static_cast<Direction>(d), 0, start,
                          std::max(start / kFromStart, kLeastBending), std::min(start * kFromStart, kMostBending)});
  }
  return parameters;
}

FabricModel with_bending(const FabricModel& model, const std::vector<FitParameter>& parameters, const Numbers& values) {
  FabricModel result = model;
  Directional& bending = result.fabric.bending_stiffness;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    along(bending, parameters[k].direction) = values[static_cast<Eigen::Index>(k)];
  if (bias_is_mean(parameters)) bending.bias = 0.5 * (bending.warp + bending.weft);
  const bool measured = std::any_of(parameters.begin(), parameters.end(),
                                    [](const FitParameter& p) { return p.direction == Direction::bias; });
  // The base's bias may be that of a limper cloth than what was measured can be.
  if (!measured) bending.bias = std::max(bending.bias, least_bias_bending(bending.warp, bending.weft));
  return result;
}

bool bias_is_mean(const std::vector<FitParameter>& bending) {
  const auto has = [&](Direction direction) {
    return std::any_of(bending.begin(), bending.end(), [&](const auto& p) { return p.direction == direction; });
  };
  return has(Direction::warp) && has(Direction::weft) && !has(Direction::bias);
}

}  // namespace toile
