#include "engine/experiments/least_squares.h"

#include <Eigen/SVD>
#include <limits>
#include <unsupported/Eigen/NonLinearOptimization>

namespace toile {
namespace {

constexpr double kScale = 1;            // the constant residual [uncertainties]
constexpr double kImprovement = 1e-3;   // relative, of the sum of squares: less is none
constexpr double kSmallestStep = 1e-6;  // of the trust region over the parameters
constexpr double kFirstStep = 1;        // radius of the trust region at first
constexpr int kMostIterations = 30;
constexpr double kNothing = 1e-6;  // a singular value that is none, beside round-off
constexpr double kFailed = 1e4;    // residual of what can't be evaluated [uncertainties], above all at the start
constexpr double kOutside = 100;  // slope of the residual of a parameter out of bounds [uncertainties over a step of 1]

/// The problem with the residuals that steer the method, in the form that Eigen asks for. Parameters count from the
/// start.
class Functor {
 public:
  /// `start`: residuals there. What can't be evaluated is worse, so that the method never ends in it.
  Functor(const LeastSquaresProblem& problem, const Numbers& start)
      : problem_(problem), failed_(kFailed + 2 * start.norm()) {}

  int inputs() const { return static_cast<int>(problem_.start.size()); }
  int values() const { return problem_.residuals + inputs() + 1; }

  int operator()(const Numbers& x, Numbers& residual) const {
    const std::optional<Numbers> found = problem_.evaluate({inside(x)}).front();
    residual.setConstant(values(), failed_);
    if (found) fill(x, *found, residual);
    return 0;
  }

  int df(const Numbers& x, Eigen::MatrixXd& jacobian) const {
    std::vector<Numbers> points = {inside(x)};
    Numbers steps = problem_.step;
    for (int k = 0; k < inputs(); ++k) {
      if (points[0][k] + steps[k] > problem_.high[k]) steps[k] = -steps[k];
      points.push_back(points[0]);
      points.back()[k] += steps[k];
    }
    const std::vector<std::optional<Numbers>> found = problem_.evaluate(points);
    jacobian.setZero(values(), inputs());
    for (int k = 0; k < inputs(); ++k) {
      if (found[0] && found[k + 1]) jacobian.col(k).head(problem_.residuals) = (*found[k + 1] - *found[0]) / steps[k];
      const double p = problem_.start[k] + x[k];
      if (p < problem_.low[k] || p > problem_.high[k]) jacobian(problem_.residuals + k, k) = kOutside;
    }
    return 0;
  }

  Numbers inside(const Numbers& x) const { return (problem_.start + x).cwiseMax(problem_.low).cwiseMin(problem_.high); }

 private:
  void fill(const Numbers& x, const Numbers& found, Numbers& residual) const {
    residual.head(problem_.residuals) = found;
    residual.segment(problem_.residuals, inputs()) = kOutside * (problem_.start + x - inside(x));
    residual[values() - 1] = kScale;
  }

  const LeastSquaresProblem& problem_;
  double failed_;
};

}  // namespace

LeastSquaresSolution least_squares(const LeastSquaresProblem& problem) {
  LeastSquaresSolution solution;
  solution.parameters = problem.start;
  const std::optional<Numbers> at_start = problem.evaluate({problem.start}).front();
  if (!at_start) {
    solution.stop_reason = "start_failed";
    return solution;
  }
  Functor functor(problem, *at_start);
  Eigen::LevenbergMarquardt<Functor> method(functor);
  method.parameters.ftol = kImprovement;
  method.parameters.xtol = kSmallestStep;
  method.parameters.factor = kFirstStep;
  method.parameters.maxfev = kMostIterations;
  method.useExternalScaling = true;
  method.diag = Numbers::Ones(functor.inputs());
  Numbers x = Numbers::Zero(functor.inputs());
  const auto status = method.minimize(x);
  solution.converged = status != Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation &&
                       status != Eigen::LevenbergMarquardtSpace::ImproperInputParameters;
  solution.stop_reason = solution.converged ? "no_better" : "too_many_iterations";
  solution.iterations = static_cast<int>(method.nfev);
  solution.parameters = functor.inside(x);
  Eigen::MatrixXd jacobian;
  functor.df(solution.parameters - problem.start, jacobian);
  solution.jacobian = jacobian.topRows(problem.residuals);
  solution.residual = *problem.evaluate({solution.parameters}).front();
  return solution;
}

Determination determination(const Eigen::MatrixXd& jacobian, const Numbers& residual) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinV);
  const Numbers& values = svd.singularValues();
  Determination result;
  result.singular_values.assign(values.begin(), values.end());
  Numbers variance = Numbers::Zero(jacobian.cols());
  for (Eigen::Index k = 0; k < values.size(); ++k)
    variance += svd.matrixV().col(k).cwiseAbs2() / std::pow(std::max(values[k], kNothing), 2);
  const Eigen::Index freedom = jacobian.rows() - jacobian.cols();
  const double scatter = freedom > 0 ? std::max(1.0, residual.squaredNorm() / static_cast<double>(freedom)) : 1;
  result.standard_error = (scatter * variance).cwiseSqrt();
  for (double& error : result.standard_error)
    if (error > 1e-3 / kNothing) error = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace toile
