#include "engine/experiments/uniaxial.h"

#include "engine/experiments/specimen.h"
#include "engine/mesh/build_cloth.h"
#include "engine/parallel/thread_limit.h"
#include "engine/quality/measure.h"
#include "engine/quality/stretch.h"
#include "engine/scene/check.h"
#include "engine/solve/backward_euler.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace toile {
namespace {

constexpr double kResidual = 1e-5;     // of the pull, at any vertex
constexpr double kStep = 0.02;         // [s]
constexpr int kMostSteps = 2000;       // to one equilibrium
constexpr double kLargestPull = 0.01;  // strain between two equilibria

/// The change of the right angle between warp and weft, by the mean of the map over the middle fifth of the strip.
double middle_shear(const Cloth& cloth, const Positions& rest, double length) {
  Eigen::Matrix<double, 3, 2> sum = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const Triangle& v = cloth.triangles[t];
    const double place = (rest[v[0]].x() + rest[v[1]].x() + rest[v[2]].x()) / 3;
    if (std::abs(place - 0.5 * length) > 0.1 * length) continue;
    const std::array<Vec2, 3>& flat = cloth.flat[t];
    Mat2 from;
    from << flat[1] - flat[0], flat[2] - flat[0];
    Eigen::Matrix<double, 3, 2> to;
    to << cloth.x[v[1]] - cloth.x[v[0]], cloth.x[v[2]] - cloth.x[v[0]];
    sum += std::abs(from.determinant()) * to * from.inverse();
  }
  return std::asin(std::clamp(sum.col(0).normalized().dot(sum.col(1).normalized()), -1.0, 1.0));
}

}  // namespace

SolverOptions pull_options() {
  SolverOptions options;
  options.gravity = false;
  options.air_drag = 0;
  options.newton_tolerance = 1e-9;
  options.newton_iterations = 30;
  options.cg_tolerance = 1e-6;
  return options;
}

UniaxialResult pull(const UniaxialTest& experiment, int threads, Monitor& monitor) {
  const auto started = std::chrono::steady_clock::now();
  const double length = experiment.length;
  const FlatMesh mesh = strip_mesh(length, experiment.width, experiment.edge_length);
  const Placement level = [](const Vec2& p) { return Vec3(p.x(), 0, -p.y()); };
  const Scene scene = experiment_scene(
      specimen("strip", mesh, level, angle_of(experiment.direction), experiment.fabric, experiment.edge_length),
      threads);
  check_scene(scene);
  const ThreadLimit limit(threads);
  UniaxialResult result;
  Cloth& cloth = result.drape.cloth = build_cloth(scene);
  const Positions rest = cloth.x;
  const std::size_t n = rest.size();
  BackwardEuler solver(cloth, pull_options());
  Kinematic grips{std::vector<char>(n, 0), rest};
  for (const double end : {0.0, length})
    for (const int v : vertices_at(mesh, end)) grips.held[v] = 1;

  State state{rest, Positions(n, Vec3::Zero())};
  std::vector<Contact> none;
  StepTimes times;
  Report& report = result.drape.report;
  report.status = "converged";
  report.stop_reason = "at_rest";
  Positions force;
  /// Force at the far grip [N].
  const auto reaction = [&] {
    double sum = 0;
    for (std::size_t v = 0; v < n; ++v)
      if (grips.held[v] && rest[v].x() > 0.5 * length) sum -= force[v].x();
    return sum;
  };
  const auto settle = [&] {
    for (int k = 0; k < kMostSteps; ++k, ++report.steps) {
      const StepOutcome outcome = solver.step(state, kStep, 1, none, grips, times);
      report.newton_iterations += outcome.newton_iterations;
      report.cg_iterations += outcome.cg_iterations;
      std::fill(state.v.begin(), state.v.end(), Vec3::Zero());
      force = solver.static_forces(state.x, none);
      double largest = 0;
      for (std::size_t v = 0; v < n; ++v)
        if (!grips.held[v]) largest = std::max(largest, force[v].norm());
      if (largest <= kResidual * std::abs(reaction())) return true;
      if (!outcome.accepted) return false;
    }
    return false;
  };

  double strain = 0;
  for (const double target : experiment.strains) {
    const int parts = std::max(1, static_cast<int>(std::ceil((target - strain) / kLargestPull - 1e-9)));
    const double from = strain;
    for (int part = 1; part <= parts; ++part) {
      const double next = from + (target - from) * part / parts;
      for (std::size_t v = 0; v < n; ++v) {
        grips.target[v].x() = (1 + next) * rest[v].x();
        state.x[v].x() *= (1 + next) / (1 + strain);  // the homogeneous guess
      }
      strain = next;
      if (!settle()) report.status = "not_converged", report.stop_reason = "no_equilibrium";
      if (!monitor.report({"drape", 0, 0, 0, 0.97 * strain / experiment.strains.back()})) throw Cancelled{};
    }
    result.report.curve.push_back({target, reaction() / experiment.width});
  }
  cloth.x = state.x;
  result.report.shear_angle = middle_shear(cloth, rest, length);

  measure_geometry(cloth, nullptr, report);
  measure_residual(force, solver.masses(), grips.held, report);
  const TriangleStretch stretch = triangle_stretch(cloth.flat, cloth.triangles, cloth.x);
  result.drape.stretch_warp = stretch.warp;
  result.drape.stretch_weft = stretch.weft;
  result.drape.contact_force.assign(n, 0.0);
  report.time.total = report.time.drape =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return result;
}

}  // namespace toile
