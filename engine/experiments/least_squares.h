#pragma once
// Least squares over few parameters whose residuals are costly and a little noisy, as those of simulated experiments.

#include "engine/types.h"

#include <functional>
#include <optional>
#include <vector>

namespace toile {

using Numbers = Eigen::VectorXd;

struct LeastSquaresProblem {
  Numbers start, low, high;  ///< parameters, where to begin and their bounds
  /// Differences of the parameters for the Jacobian: far above the residuals' noise over its slope.
  Numbers step;
  int residuals = 0;
  /// The residuals at each of the points, in units of their uncertainty; nothing where they can't be had. Points are
  /// asked for together so that they may be found in parallel. Never asked outside of the bounds.
  std::function<std::vector<std::optional<Numbers>>(const std::vector<Numbers>& points)> evaluate;
};

struct LeastSquaresSolution {
  Numbers parameters, residual;
  Eigen::MatrixXd jacobian;  ///< by forward differences, at the parameters
  int iterations = 0;        ///< steps tried
  bool converged = false;
  std::string stop_reason;  ///< "no_better", "too_many_iterations", "start_failed"
};

/// Levenberg–Marquardt (Moré 1978, MINPACK's lmder, in Eigen's unsupported module). The first step is no longer than 1:
/// parameters are meant to be logarithms. One more residual, constant, of one uncertainty gives
/// its test of relative improvement (a thousandth of the sum of squares) a scale where the fit is exact; a step to
/// where nothing can be evaluated is taken back. Parameters end within their bounds.
LeastSquaresSolution least_squares(const LeastSquaresProblem& problem);

/// What a Jacobian of residuals over uncertainty says of the parameters.
struct Determination {
  std::vector<double> singular_values;  ///< falling
  Numbers standard_error;               ///< of each parameter, in its unit; may be infinite
};

/// There are no fewer residuals than parameters. Standard errors are the roots of the diagonal of (Jᵀ J)⁻¹, times the
/// root of the residuals' χ² per degree of freedom where that exceeds 1.
Determination determination(const Eigen::MatrixXd& jacobian, const Numbers& residual);

}  // namespace toile
