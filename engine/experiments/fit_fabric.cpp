#include "engine/experiments/fit_fabric.h"

#include "engine/experiments/fit_part.h"
#include "engine/parallel/thread_limit.h"
#include "engine/scene/check_parts.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

namespace toile {
namespace {

constexpr double kStretchStep = 0.02, kBendingStep = 0.05;  // of logarithms; the experiments' noise is 1e-5 and 1e-4
constexpr double kLargestMisfit = 5;                        // rms [uncertainties]
constexpr double kExpected = 30;                            // progress calls that make half of a bar, per specimen
constexpr std::array kDirections = {Direction::warp, Direction::weft, Direction::bias};

std::size_t index(Direction direction) { return static_cast<std::size_t>(direction); }

/// One at a time to a monitor that knows no threads; the share done is a guess that never falls.
class OneAtATime final : public Monitor {
 public:
  OneAtATime(Monitor& whole, double half) : whole_(whole), half_(half) {}
  bool report(const Progress&) override {
    const std::lock_guard lock(mutex_);
    calls_ += 1;
    return whole_.report({"fit", 0, 0, 0, calls_ / (calls_ + half_)});
  }

 private:
  std::mutex mutex_;
  Monitor& whole_;
  double half_, calls_ = 0;
};

void add_pull(const MeasuredPull& test, Direction direction, PartProblem& part) {
  PartSpecimen specimen{test, direction, {}};
  const std::string at =
      direction == Direction::bias ? "/bias_extension" : std::string("/uniaxial/") + name_of(direction);
  for (std::size_t i = 0; i < test.readings.size(); ++i)
    specimen.rows.push_back({at + "/readings/" + std::to_string(i), MisfitRow::Quantity::force, test.readings[i].strain,
                             test.readings[i].force, 0, test.uncertainty});
  part.specimens.push_back(std::move(specimen));
}

PartProblem stretch_problem(const FabricMeasurements& m) {
  PartProblem part;
  part.name = "stretch";
  part.parameters = stretch_parameters(m);
  part.step = kStretchStep;
  part.own_direction = true;  // a tenth more stiffness in another direction changes the force by under 0.02 %
  for (const Direction direction : kDirections)
    if (m.pulls[index(direction)]) add_pull(*m.pulls[index(direction)], direction, part);
  if (m.shear)
    part.direct.push_back(
        {Direction::bias, {"/shear_N_m", MisfitRow::Quantity::shear, {}, m.shear->value, 0, m.shear->uncertainty}});
  part.model = [&m, parameters = part.parameters](const Numbers& values) {
    return with_stretch(m, parameters, values);
  };
  return part;
}

PartProblem bending_problem(const FabricMeasurements& m, const FabricModel& stretched) {
  using Quantity = MisfitRow::Quantity;
  PartProblem part;
  part.name = "bending";
  part.parameters = bending_parameters(m);
  part.step = kBendingStep;
  part.own_direction = false;  // a bias much stiffer than warp and weft is felt by their strips' edges
  for (const Direction direction : kDirections) {
    const std::size_t d = index(direction);
    const std::string key = std::string("/") + name_of(direction);
    if (const auto& test = m.cantilevers[d]) {
      const Quantity read = test->reading == MeasuredCantilever::Reading::drop ? Quantity::drop : Quantity::angle;
      part.specimens.push_back(
          {*test, direction, {{"/cantilever" + key, read, {}, test->value, 0, test->uncertainty}}});
    }
    if (const auto& test = m.loops[d])
      part.specimens.push_back(
          {*test, direction, {{"/pear_loop" + key, Quantity::height, {}, test->height, 0, test->uncertainty}}});
    if (const auto& test = m.bending[d])
      part.direct.push_back(
          {direction, {"/bending_uN_m" + key, Quantity::bending, {}, test->value, 0, test->uncertainty}});
  }
  part.model = [&stretched, parameters = part.parameters](const Numbers& values) {
    return with_bending(stretched, parameters, values);
  };
  return part;
}

void take_over(PartSolution&& solution, FabricFit& fit) {
  fit.misfit.insert(fit.misfit.end(), solution.rows.begin(), solution.rows.end());
  fit.simulations += solution.simulations;
  if (!solution.part.converged && fit.stop_reason.empty()) fit.stop_reason = solution.part.stop_reason;
  fit.parts.push_back(std::move(solution.part));
}

void measure_misfit(FabricFit& fit) {
  double relative = 0, weighted = 0;
  for (const MisfitRow& row : fit.misfit) {
    const double difference = row.fitted / row.measured - 1;
    relative += difference * difference;
    weighted += difference * difference / (row.uncertainty * row.uncertainty);
  }
  const double count = std::max<double>(1, static_cast<double>(fit.misfit.size()));
  fit.rms = std::sqrt(relative / count);
  fit.rms_over_uncertainty = std::sqrt(weighted / count);
  if (fit.stop_reason.empty() && fit.rms_over_uncertainty > kLargestMisfit) fit.stop_reason = "misfit_too_large";
  fit.status = fit.stop_reason.empty() ? "fitted" : "not_fitted";
  if (fit.stop_reason.empty()) fit.stop_reason = "fitted";
}

std::string list_of(const std::vector<Direction>& directions) {
  std::string text;
  for (const Direction direction : directions) text += (text.empty() ? "" : ", ") + std::string(name_of(direction));
  return text;
}

/// What was not measured, with a warning where a drape depends on it.
void say_what_is_kept(const FabricMeasurements& m, FabricFit& fit) {
  const std::string& base = m.base.name;
  const auto keep = [&](const char* key, const std::vector<Direction>& directions) {
    for (const Direction direction : directions) fit.kept.push_back(std::string(key) + name_of(direction));
  };
  std::vector<Direction> stretch, bending;
  for (const Direction direction : kDirections) {
    const std::size_t d = index(direction);
    if (direction != Direction::bias && !m.pulls[d]) stretch.push_back(direction);
    if (!m.cantilevers[d] && !m.loops[d] && !m.bending[d]) bending.push_back(direction);
  }
  keep("/stretch_N_m/", stretch);
  if (!stretch.empty())
    fit.warnings.push_back("stretch_not_measured: no test pulls along " + list_of(stretch) +
                           "; that stiffness is that of " + base + ".");
  if (!m.pulls[index(Direction::bias)] && !m.shear) {
    fit.kept.emplace_back("/stretch_N_m/bias");
    fit.warnings.push_back("shear_not_measured: no test tells the shear stiffness; it is that of " + base + ".");
  }
  if (bending == std::vector{Direction::bias}) {
    fit.warnings.emplace_back(
        "bias_bending_not_measured: no test bends the bias; its stiffness is the mean of warp and weft.");
  } else if (!bending.empty()) {
    keep("/bending_uN_m/", bending);
    fit.warnings.push_back("bending_not_measured: no test bends " + list_of(bending) + "; that stiffness is that of " +
                           base + ".");
  }
  if (!m.poisson_ratio) fit.kept.emplace_back("/poisson_ratio");
  if (!m.thickness) fit.kept.emplace_back("/thickness_mm");
  if (m.base.bending_softening != Directional{}) fit.kept.emplace_back("/bending_softening_mm");
  if (m.base.bending_hysteresis != Directional{}) fit.kept.emplace_back("/bending_hysteresis_uN");
  for (const char* key : {"/friction_cloth", "/friction_body", "/damping_s"}) fit.kept.emplace_back(key);
}

void warn_of_undetermined(FabricFit& fit) {
  for (const FitPart& part : fit.parts)
    for (const ParameterEstimate& e : part.parameters)
      if (!e.determined)
        fit.warnings.push_back("not_determined: " + e.pointer +
                               (e.strain ? " at " + std::to_string(100 * *e.strain) + " % strain" : "") +
                               " is no better than a guess: the measurements hardly depend on it, contradict one "
                               "another, or draw it to the end of what is possible.");
}

}  // namespace

FabricFit fit_fabric(const FabricMeasurements& m, int threads, Monitor& monitor) {
  std::vector<Problem> problems = measurement_problems(m);
  if (!problems.empty()) throw InputError(std::move(problems));
  const auto started = std::chrono::steady_clock::now();
  const ThreadLimit limit(threads);
  const PartProblem stretch = stretch_problem(m);
  const std::size_t bent = bending_parameters(m).size();
  OneAtATime shared(monitor, kExpected * 100 * static_cast<double>(stretch.specimens.size() + bent));
  FabricFit fit;
  FabricModel model = base_model(m);
  if (!stretch.parameters.empty()) {
    PartSolution solution = fit_part(stretch, shared);
    model = with_stretch(m, stretch.parameters, solution.values);
    take_over(std::move(solution), fit);
  }
  const PartProblem bending = bending_problem(m, model);
  if (!bending.parameters.empty()) {
    PartSolution solution = fit_part(bending, shared);
    const FabricModel bent_model = with_bending(model, bending.parameters, solution.values);
    take_over(std::move(solution), fit);
    model = bent_model;
  }
  fit.fabric = model.fabric;
  fit.stretch = model.stretch;
  measure_misfit(fit);
  check_fabric(fit.fabric, "", problems);
  for (const Problem& problem : problems) fit.warnings.push_back("no_such_fabric: " + problem.detail);
  if (!problems.empty()) {
    fit.status = "not_fitted";
    fit.stop_reason = "no_such_fabric";
  }
  say_what_is_kept(m, fit);
  warn_of_undetermined(fit);
  fit.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return fit;
}

}  // namespace toile
