#include "engine/experiments/cusick_drape.h"

#include "engine/experiments/part_monitor.h"
#include "engine/experiments/shadow.h"
#include "engine/experiments/specimen.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace toile {
namespace {

constexpr double kWave = 0.05;          ///< height of the start's waves at the rim over the overhang
constexpr double kLoweringStep = 0.01;  ///< slow loading needs no smaller ones [s]
constexpr int kRays = 720;              ///< of the outline
constexpr int kHarmonics = 12;
constexpr double kNodeProminence = 0.05;  ///< of the overhang: what an eye sees as a fold
constexpr int kLeastRealNodes = 3, kMostRealNodes = 8;
constexpr double kPlate = 0.002;  ///< half the thickness of the two plates, for pictures [m]
constexpr double kPi = std::numbers::pi;

struct Ring {
  FlatMesh mesh;
  std::vector<int> inner;  ///< vertices of the inner circle
};

/// Half the ring by the panel mesher, and the same turned by half a turn.
Ring ring_mesh(double inner, double outer, double edge_length) {
  const auto parts = [&](double length) { return std::max(3, static_cast<int>(std::lround(length / edge_length))); };
  const int outside = parts(kPi * outer), inside = parts(kPi * inner), across = parts(outer - inner);
  std::vector<Vec2> outline;
  const auto on_circle = [](double radius, double angle) {
    return Vec2(radius * std::cos(angle), radius * std::sin(angle));
  };
  for (int k = 0; k < outside; ++k) outline.push_back(on_circle(outer, kPi * k / outside));
  for (int k = 0; k < across; ++k) outline.emplace_back(-outer + (outer - inner) * k / across, 0);
  for (int k = 0; k < inside; ++k) outline.push_back(on_circle(inner, kPi * (inside - k) / inside));
  for (int k = 0; k < across; ++k) outline.emplace_back(inner + (outer - inner) * k / across, 0);
  const FlatMesh half = mesh_polygon(outline, edge_length);

  Ring ring{half, {}};
  const int left = outside, right = outside + across + inside, count = static_cast<int>(half.vertices.size());
  // The cuts' points in the order from the left outer end, and from the right inner end: their images under the turn.
  std::vector<int> image(static_cast<std::size_t>(count), -1);
  for (int k = 0; k <= across; ++k) {
    const int on_left = left + k, on_right = k == 0 ? 0 : right + across - k;
    image[on_left] = on_right;
    image[on_right] = on_left;
  }
  for (int v = 0; v < count; ++v) {
    if (image[v] >= 0) continue;
    image[v] = static_cast<int>(ring.mesh.vertices.size());
    ring.mesh.vertices.emplace_back(-half.vertices[v]);
  }
  for (const Triangle& t : half.triangles) ring.mesh.triangles.push_back({image[t[0]], image[t[1]], image[t[2]]});
  for (std::size_t v = 0; v < ring.mesh.vertices.size(); ++v)
    if (ring.mesh.vertices[v].norm() < inner + 1e-9) ring.inner.push_back(static_cast<int>(v));
  return ring;
}

/// Height over the level, −1 to 1: the sum of 2 to 10 waves, with phases that follow the golden angle, other ones for
/// each start.
double waves(int start, double angle) {
  constexpr double kGolden = 2.399963;
  double sum = 0;
  for (int k = 2; k <= 10; ++k) sum += std::cos(k * angle + kGolden * (k * k + start * (7 * k + 1))) / 9;
  return sum;
}

TriangleMesh plates(double radius) {
  constexpr int kSides = 96;
  TriangleMesh mesh;
  mesh.vertices = {Vec3(0, kPlate, 0), Vec3(0, -kPlate, 0)};
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * kPi * k / kSides;
    for (const double y : {kPlate, -kPlate})
      mesh.vertices.emplace_back(radius * std::cos(angle), y, -radius * std::sin(angle));
    const int top = 2 + 2 * k, bottom = top + 1, next = 2 + 2 * ((k + 1) % kSides);
    mesh.triangles.insert(mesh.triangles.end(),
                          {{0, top, next}, {1, next + 1, bottom}, {top, bottom, next}, {next, bottom, next + 1}});
  }
  return mesh;
}

}  // namespace

CusickResult hang(const CusickDrape& experiment, int threads, Monitor& monitor) {
  const double inner = 0.5 * experiment.support_diameter, outer = 0.5 * experiment.disc_diameter,
               overhang = outer - inner;
  const Ring ring = ring_mesh(inner, outer, experiment.edge_length);
  CusickResult result;
  double least = std::numeric_limits<double>::infinity();
  int counted = 0;
  for (int k = 0; k < experiment.starts; ++k) {
    CusickStart start;
    const Placement place = [&](const Vec2& p) {
      const double share = (p.norm() - inner) / overhang;
      return Vec3(p.x(), kWave * overhang * share * share * waves(k, std::atan2(p.y(), p.x())), -p.y());
    };
    Garment disc = specimen("disc", ring.mesh, place, 0, experiment.fabric, experiment.edge_length);
    disc.pins = {{PinVertices{ring.inner}, PinFixed{}, true}};
    PartMonitor part(monitor, k / static_cast<double>(experiment.starts),
                     (k + 1) / static_cast<double>(experiment.starts));
    Scene scene = experiment_scene(std::move(disc), threads);
    scene.solver.weight_ramp_time = experiment.lowering_time;
    if (experiment.lowering_time > 0) scene.solver.max_time_step = kLoweringStep;
    scene.solver.simulated_time_limit += experiment.lowering_time;
    Drape drape = drape_specimen(scene, part);

    start.at_rest = drape.report.status == "converged";
    const double whole = kPi * (outer * outer - inner * inner);
    start.coefficient = shadow_area_beyond(inner, drape.cloth.x, drape.cloth.triangles) / whole;
    const std::vector<double> outline = shadow_outline(inner, drape.cloth.x, drape.cloth.triangles, kRays);
    start.nodes = node_count(outline, kNodeProminence * overhang);
    start.node_amplitudes = harmonics(outline, kHarmonics);
    start.node_amplitudes.erase(start.node_amplitudes.begin());
    for (const TermEnergy& term : drape.report.energies) start.energy += term.energy;
    if (start.at_rest) {
      result.report.coefficient += start.coefficient;
      result.report.nodes += start.nodes;
      ++counted;
    }
    if (k == 0 || (start.at_rest && start.energy < least)) {
      if (start.at_rest) least = start.energy;
      result.drape = std::move(drape);
    }
    result.report.starts.push_back(std::move(start));
  }
  std::vector<std::string>& warnings = result.drape.report.warnings;
  for (const CusickStart& start : result.report.starts)
    if (start.nodes > kMostRealNodes || (start.nodes > 0 && start.nodes < kLeastRealNodes))
      warnings.push_back("unusual_nodes: a specimen hangs in " + std::to_string(start.nodes) +
                         " folds; real cloth in " + std::to_string(kLeastRealNodes) + " to " +
                         std::to_string(kMostRealNodes));
  if (counted > 0) {
    result.report.coefficient /= counted;
    result.report.nodes /= counted;
  }
  result.drape.body_mesh = plates(inner);
  return result;
}

}  // namespace toile
