#include "engine/experiments/cantilever.h"

#include "engine/experiments/part_monitor.h"
#include "engine/experiments/specimen.h"
#include "engine/scene/fabric_measurements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {
namespace {

constexpr double kPeirceAngle = 41.5 * std::numbers::pi / 180;     // [rad]
constexpr double kAngleTolerance = 0.05 * std::numbers::pi / 180;  // [rad]
constexpr int kMostTrials = 8;
constexpr double kShortest = 2e-3, kLongest = 1;  // overhang [m]
constexpr double kCells = 12, kMostCells = 120;   // edges along the overhang
constexpr double kCellsPerLength = 6;             // and along the bending length, where the strip curves

/// Peirce's (D / (ρ g))^⅓ of an elastic strip [m].
double elastic_bending_length(const Cantilever& experiment) {
  return std::cbrt(along(experiment.fabric.bending_stiffness, experiment.direction) /
                   (experiment.fabric.area_density * kGravity));
}

double edge_for(const Cantilever& experiment, double overhang) {
  if (experiment.edge_length > 0) return experiment.edge_length;
  const double curved = elastic_bending_length(experiment);
  return std::max(std::min(overhang / kCells, curved / kCellsPerLength), overhang / kMostCells);
}

CantileverResult bend(const Cantilever& experiment, double overhang, int threads, Monitor& monitor) {
  const double edge = edge_for(experiment, overhang);
  const FlatMesh mesh = strip_mesh(overhang, experiment.width, edge);
  const Placement level = [](const Vec2& p) { return Vec3(p.x(), 0, -p.y()); };
  Garment strip = specimen("strip", mesh, level, angle_of(experiment.direction), experiment.fabric, edge);
  strip.pins = {{PinVertices{vertices_at(mesh, 0)}, PinFixed{}, true}};
  CantileverResult result;
  result.report.overhang = overhang;
  result.drape = drape_specimen(experiment_scene(std::move(strip), threads), monitor);
  Vec3 end = Vec3::Zero();
  const std::vector<int> last = vertices_at(mesh, overhang);
  for (const int v : last) end += result.drape.cloth.x[v] / static_cast<double>(last.size());
  result.report.angle = std::atan2(-end.y(), end.x());
  result.report.drop = -end.y();
  return result;
}

}  // namespace

CantileverResult bend_over(const Cantilever& experiment, int threads, Monitor& monitor) {
  if (experiment.overhang) return bend(experiment, *experiment.overhang, threads, monitor);
  double overhang = 2 * elastic_bending_length(experiment);
  double slope = 1;  // of the angle over log overhang; near 41.5° of an elastic strip
  double last_log = 0, last_angle = 0;
  CantileverResult result;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    overhang = std::clamp(overhang, kShortest, kLongest);
    PartMonitor part(monitor, 1 - std::pow(0.5, trial), 1 - std::pow(0.5, trial + 1));
    result = bend(experiment, overhang, threads, part);
    if (result.drape.report.status != "converged") return result;
    if (std::abs(result.report.angle - kPeirceAngle) < kAngleTolerance) {
      result.report.bending_length = 0.5 * overhang;
      return result;
    }
    if (overhang == (result.report.angle < kPeirceAngle ? kLongest : kShortest)) break;
    const double now = std::log(overhang);
    if (trial > 0 && std::abs(now - last_log) > 1e-9)
      slope = std::clamp((result.report.angle - last_angle) / (now - last_log), 0.2, 3.0);
    last_log = now;
    last_angle = result.report.angle;
    overhang *= std::exp(std::clamp((kPeirceAngle - result.report.angle) / slope, -0.7, 0.7));
  }
  result.drape.report.status = "not_converged";
  result.drape.report.stop_reason = "no_overhang_falls_so_far";
  return result;
}

}  // namespace toile
