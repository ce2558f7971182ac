#include "engine/quality/measure.h"

#include "engine/parallel/state_hash.h"
#include "engine/quality/intersections.h"
#include "engine/quality/penetration.h"
#include "engine/quality/stretch.h"

#include <cmath>
#include <cstdio>

namespace toile {
namespace {

constexpr double kOverstretched = 0.05;    // 99th percentile of a woven fabric's stretch
constexpr double kDeepPenetration = 2e-3;  // [m]
constexpr double kLargeResidual = 0.1;     // rms of the net force over nodal weight

std::string sentence(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void measure_geometry(const Cloth& cloth, const BodyField* body, Report& report) {
  report.vertices = static_cast<long>(cloth.x.size());
  report.triangles = static_cast<long>(cloth.triangles.size());
  const TriangleStretch stretch = triangle_stretch(cloth.flat, cloth.triangles, cloth.x);
  report.stretch_warp = stretch_statistics(stretch.warp, stretch.area);
  report.stretch_weft = stretch_statistics(stretch.weft, stretch.area);
  report.penetration_max = body ? deepest_penetration(*body, cloth.x, cloth.triangles).depth : 0;
  report.self_intersections = static_cast<long>(self_intersections(cloth.x, cloth.triangles).size());
  report.result_sha256 = sha256_hex(cloth.x);
}

void measure_residual(const Positions& net_force, const std::vector<double>& mass, const std::vector<char>& held,
                      Report& report) {
  double sum = 0, largest = 0;
  long count = 0;
  for (std::size_t v = 0; v < net_force.size(); ++v) {
    if (held[v] || mass[v] <= 0) continue;
    const double share = net_force[v].norm() / (mass[v] * kGravity);
    sum += share * share;
    largest = std::max(largest, share);
    ++count;
  }
  report.residual_rms = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
  report.residual_max = largest;
}

void add_warnings(const Cloth& cloth, Report& report) {
  bool woven = !cloth.fabrics.empty();
  for (const Fabric& fabric : cloth.fabrics) woven = woven && fabric.woven;
  const double stretch = std::max(report.stretch_warp.p99, report.stretch_weft.p99);
  if (woven && stretch > kOverstretched)
    report.warnings.push_back(
        sentence("over-stretched: 1 %% of the woven fabric is stretched by more than %.1f %%", 100 * stretch));
  if (report.self_intersections > 0)
    report.warnings.push_back(sentence("the cloth passes through itself at %.0f pairs of triangles",
                                       static_cast<double>(report.self_intersections)));
  if (report.penetration_max > kDeepPenetration)
    report.warnings.push_back(sentence("the cloth is %.1f mm inside the body", 1000 * report.penetration_max));
  if (report.residual_rms > kLargeResidual)
    report.warnings.push_back(
        sentence("forces do not balance yet: rms residual %.2f of the nodal weight", report.residual_rms));
}

}  // namespace toile
