#include "engine/experiments/pear_loop.h"

#include "engine/experiments/specimen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCells = 60;           // edges along the strip
constexpr double kOutwards = 0.3;       // share of a side that turns outwards at the start
constexpr int kParts = 4000;            // of a side, where it is integrated
constexpr double kSqueezed = 0.01;      // share of the area beyond the model
constexpr double kWeightless = 0.4243;  // height over length [Peirce 1930]
constexpr double kTellable = 0.005;     // of the height, what a laboratory reads it to

/// Points of one side from the clamp to the bottom: turning outwards by `turn` over the first part and then back until
/// it runs inwards level.
std::vector<Vec2> side_of(double length, double turn) {
  std::vector<Vec2> points = {Vec2::Zero()};
  const double ds = length / kParts;
  for (int k = 0; k < kParts; ++k) {
    const double share = (k + 0.5) / kParts;
    const double angle =
        share < kOutwards ? turn * share / kOutwards : turn - (turn + kPi / 2) * (share - kOutwards) / (1 - kOutwards);
    points.push_back(points.back() + ds * Vec2(std::sin(angle), -std::cos(angle)));
  }
  return points;
}

/// The side that ends `inwards` of where it began.
std::vector<Vec2> closing_side(double length, double inwards) {
  double low = 0, high = kPi / 2;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (side_of(length, middle).back().x() < -inwards ? low : high) = middle;
  }
  return side_of(length, high);
}

}  // namespace

PearLoopResult hang_loop(const PearLoop& experiment, int threads, Monitor& monitor) {
  const double edge = experiment.edge_length > 0 ? experiment.edge_length : experiment.length / kCells;
  const double half = 0.5 * experiment.length, gap = experiment.fabric.thickness;
  const FlatMesh mesh = strip_mesh(experiment.length, experiment.width, edge);
  const std::vector<Vec2> side = closing_side(half, 0.5 * gap);
  const Placement loop = [&](const Vec2& p) {
    const bool right = p.x() < half;
    const double place = std::clamp((right ? p.x() : experiment.length - p.x()) / half, 0.0, 1.0) * kParts;
    const int k = std::min(static_cast<int>(place), kParts - 1);
    const Vec2 q = side[k] + (place - k) * (side[k + 1] - side[k]);
    return Vec3((right ? 1 : -1) * (q.x() + 0.5 * gap), q.y(), -p.y());
  };
  Garment strip = specimen("loop", mesh, loop, angle_of(experiment.direction), experiment.fabric, edge);
  std::vector<int> ends = vertices_at(mesh, 0);
  const std::vector<int> last = vertices_at(mesh, experiment.length);
  ends.insert(ends.end(), last.begin(), last.end());
  strip.pins = {{PinVertices{ends}, PinFixed{}, true}};
  Scene scene = experiment_scene(std::move(strip), threads);
  scene.solver.contact_distance = gap;
  PearLoopResult result;
  result.drape = drape_specimen(scene, monitor);
  for (const Vec3& x : result.drape.cloth.x) result.report.height = std::max(result.report.height, -x.y());
  Report& report = result.drape.report;
  if (report.status == "converged" && report.compressed_share > kSqueezed) {
    report.status = "not_converged";
    report.stop_reason = "compressed_beyond_model";
  }
  if (report.status == "converged" && result.report.height < kWeightless * (1 + kTellable) * experiment.length)
    report.warnings.emplace_back(
        "stiff_loop: the height is within half a per cent of a weightless loop's (0.4243 of the length): it tells "
        "nothing of this stiffness; a longer strip would");
  return result;
}

}  // namespace toile
