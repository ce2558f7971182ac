#include "engine/experiments/fit_part.h"

#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile {
namespace {

constexpr int kMostCorrections = 5;
constexpr double kSettled = 0.25;    // change of a correction [uncertainties]
constexpr double kDetermined = 0.5;  // standard error of a logarithm
constexpr double kAtBound = 1e-3;    // distance of a logarithm from its bound

using Readings = std::optional<std::vector<double>>;
using Key = std::vector<double>;

/// Remembers what each specimen did at the parameters that it depends on.
class Laboratory {
 public:
  Laboratory(const PartProblem& problem, Monitor& monitor)
      : problem_(problem), monitor_(monitor), known_(problem.specimens.size()) {}

  /// Of every specimen at every point.
  std::vector<std::vector<Readings>> test(const std::vector<Numbers>& points, const std::vector<SpecimenMesh>& meshes) {
    std::vector<std::optional<Fabric>> fabrics;
    for (const Numbers& point : points) fabrics.push_back(fabric(point));
    run_missing(points, meshes, fabrics);
    std::vector<std::vector<Readings>> found(points.size(), std::vector<Readings>(problem_.specimens.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t s = 0; fabrics[i] && s < problem_.specimens.size(); ++s)
        found[i][s] = known_[s][static_cast<std::size_t>(meshes[i])].at(key(s, points[i]));
    return found;
  }

  std::optional<Fabric> fabric(const Numbers& logarithms) const {
    try {
      return problem_.model(logarithms.array().exp()).fabric;
    } catch (const InputError&) {
      return {};
    }
  }

  long simulations() const { return simulations_; }

 private:
  struct Task {
    std::size_t specimen;
    SpecimenMesh mesh;
    Fabric fabric;
    Readings* result;
  };

  Key key(std::size_t specimen, const Numbers& logarithms) const {
    Key values;
    const Direction direction = problem_.specimens[specimen].direction;
    for (std::size_t k = 0; k < problem_.parameters.size(); ++k)
      if (!problem_.own_direction || direction == Direction::bias || problem_.parameters[k].direction == direction)
        values.push_back(logarithms[static_cast<Eigen::Index>(k)]);
    return values;
  }

  void run_missing(const std::vector<Numbers>& points, const std::vector<SpecimenMesh>& meshes,
                   const std::vector<std::optional<Fabric>>& fabrics) {
    std::vector<Task> tasks;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t s = 0; fabrics[i] && s < problem_.specimens.size(); ++s) {
        const auto [place, is_new] =
            known_[s][static_cast<std::size_t>(meshes[i])].try_emplace(key(s, points[i]), std::nullopt);
        if (is_new) tasks.push_back({s, meshes[i], *fabrics[i], &place->second});
      }
    simulations_ += static_cast<long>(tasks.size());
    parallel_for_each(static_cast<int>(tasks.size()), 1, [&](int i) {
      const Task& task = tasks[static_cast<std::size_t>(i)];
      const PartSpecimen& specimen = problem_.specimens[task.specimen];
      *task.result = test_again(specimen.test, specimen.direction, task.fabric, task.mesh, monitor_);
    });
  }

  const PartProblem& problem_;
  Monitor& monitor_;
  std::vector<std::array<std::map<Key, Readings>, 2>> known_;  ///< by specimen and mesh
  long simulations_ = 0;
};

double direct_value(const DirectReading& reading, const Fabric& fabric) {
  return reading.row.quantity == MisfitRow::Quantity::shear ? fabric.stretch_stiffness.bias
                                                            : along(fabric.bending_stiffness, reading.direction);
}

/// Logarithms of all rows at a point on coarse meshes, those of specimens first.
class Rows {
 public:
  Rows(const PartProblem& problem, Laboratory& laboratory) : problem_(problem), laboratory_(laboratory) {
    for (const PartSpecimen& specimen : problem.specimens)
      rows_.insert(rows_.end(), specimen.rows.begin(), specimen.rows.end());
    for (const DirectReading& reading : problem.direct) rows_.push_back(reading.row);
    correction_ = Numbers::Zero(static_cast<Eigen::Index>(rows_.size()));
  }

  int count() const { return static_cast<int>(rows_.size()); }

  std::vector<std::optional<Numbers>> residuals(const std::vector<Numbers>& points) {
    const auto found = laboratory_.test(points, std::vector(points.size(), SpecimenMesh::coarse));
    std::vector<std::optional<Numbers>> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::optional<Numbers> logs = logarithms(points[i], found[i]);
      if (logs)
        for (int k = 0; k < count(); ++k) {
          const MisfitRow& row = rows_[static_cast<std::size_t>(k)];
          (*logs)[k] = ((*logs)[k] + correction_[k] - std::log(row.measured)) / row.uncertainty;
        }
      result.push_back(std::move(logs));
    }
    return result;
  }

  /// By how many uncertainties the correction changed at most; nothing where a specimen failed.
  std::optional<double> correct(const Numbers& point) {
    const auto found = laboratory_.test({point, point}, {SpecimenMesh::coarse, SpecimenMesh::fine});
    double largest = 0;
    Eigen::Index k = 0;
    for (std::size_t s = 0; s < problem_.specimens.size(); ++s) {
      const Readings &coarse = found[0][s], &fine = found[1][s];
      if (!coarse || !fine) return {};
      const std::vector<double> exact = extrapolated(*coarse, *fine);
      for (std::size_t i = 0; i < exact.size(); ++i, ++k) {
        if (!((*coarse)[i] > 0 && exact[i] > 0)) return {};
        const double now = std::log(exact[i] / (*coarse)[i]);
        largest = std::max(largest, std::abs(now - correction_[k]) / rows_[static_cast<std::size_t>(k)].uncertainty);
        correction_[k] = now;
      }
    }
    return largest;
  }

  std::vector<MisfitRow> fitted(const Numbers& point) {
    std::vector<MisfitRow> rows = rows_;
    const std::optional<Numbers> found = residuals({point}).front();
    if (!found) return {};
    for (std::size_t k = 0; k < rows.size(); ++k)
      rows[k].fitted = rows[k].measured * std::exp((*found)[static_cast<Eigen::Index>(k)] * rows[k].uncertainty);
    return rows;
  }

 private:
  std::optional<Numbers> logarithms(const Numbers& point, const std::vector<Readings>& found) const {
    Numbers logs(count());
    Eigen::Index k = 0;
    for (const Readings& readings : found) {
      if (!readings) return {};
      for (const double value : *readings) {
        if (!(value > 0)) return {};
        logs[k++] = std::log(value);
      }
    }
    const std::optional<Fabric> fabric = laboratory_.fabric(point);
    if (!fabric) return {};
    for (const DirectReading& reading : problem_.direct) logs[k++] = std::log(direct_value(reading, *fabric));
    return logs;
  }

  const PartProblem& problem_;
  Laboratory& laboratory_;
  std::vector<MisfitRow> rows_;

  Numbers correction_;
};

std::string pointer_of(const FitParameter& p) {
  const char* key = p.kind == FitParameter::Kind::bending   ? "/bending_uN_m/"
                    : p.kind == FitParameter::Kind::modulus ? "/stretch_N_m/"
                                                            : "/stretch_curve/";
  return std::string(key) + name_of(p.direction);
}

LeastSquaresProblem least_squares_problem(const PartProblem& problem, Rows& rows) {
  const auto n = static_cast<Eigen::Index>(problem.parameters.size());
  LeastSquaresProblem fit{Numbers(n), Numbers(n), Numbers(n), Numbers::Constant(n, problem.step), rows.count(), {}};
  for (Eigen::Index k = 0; k < n; ++k) {
    const FitParameter& p = problem.parameters[static_cast<std::size_t>(k)];
    fit.start[k] = std::log(p.start);
    fit.low[k] = std::log(p.low);
    fit.high[k] = std::log(p.high);
  }
  fit.evaluate = [&rows](const std::vector<Numbers>& points) { return rows.residuals(points); };
  return fit;
}

void estimate(const PartProblem& problem, const LeastSquaresProblem& fit, const LeastSquaresSolution& solution,
              FitPart& part) {
  const Determination known = determination(solution.jacobian, solution.residual);
  part.singular_values = known.singular_values;
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const FitParameter& p = problem.parameters[k];
    ParameterEstimate e;
    e.pointer = pointer_of(p);
    if (p.kind == FitParameter::Kind::curve_factor) e.strain = p.strain;
    e.value = std::exp(solution.parameters[i]);
    e.standard_error = known.standard_error[i];
    const double from_bound = std::min(solution.parameters[i] - fit.low[i], fit.high[i] - solution.parameters[i]);
    e.determined = e.standard_error < kDetermined && from_bound > kAtBound;
    part.parameters.push_back(std::move(e));
  }
}

}  // namespace

PartSolution fit_part(const PartProblem& problem, Monitor& monitor) {
  Laboratory laboratory(problem, monitor);
  Rows rows(problem, laboratory);
  LeastSquaresProblem fit = least_squares_problem(problem, rows);
  PartSolution result;
  result.part.name = problem.name;
  result.part.stop_reason = "specimen_failed";
  result.values = fit.start.array().exp();
  const auto finish = [&] {
    result.simulations = laboratory.simulations();
    return result;
  };
  if (!rows.correct(fit.start)) return finish();
  for (;;) {
    ++result.part.corrections;
    const LeastSquaresSolution solution = least_squares(fit);
    result.part.iterations += solution.iterations;
    fit.start = solution.parameters;
    result.values = fit.start.array().exp();
    const std::optional<double> change =
        solution.stop_reason == "start_failed" ? std::nullopt : rows.correct(fit.start);
    if (!change) return finish();
    const bool settled = *change < kSettled;
    if (!settled && solution.converged && result.part.corrections < kMostCorrections) continue;
    result.part.converged = solution.converged && settled;
    result.part.stop_reason = solution.converged && !settled ? "mesh_error_unsettled" : solution.stop_reason;
    estimate(problem, fit, solution, result.part);
    result.rows = rows.fitted(fit.start);
    return finish();
  }
}

}  // namespace toile
