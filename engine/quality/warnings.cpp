#include "engine/quality/warnings.h"

#include <algorithm>
#include <cstdio>

namespace toile {
namespace {

constexpr double kOverstretched = 0.05;    // 99th percentile of a woven fabric's stretch
constexpr double kCompressedShare = 1e-3;  // of the area, squeezed beyond StVK
constexpr double kDeepPenetration = 2e-3;  // [m]
constexpr double kLargeResidual = 0.1;     // rms of the net force over nodal weight
constexpr double kThinLayer = 0.1;         // contact distance over edge length; layers meet few features of each other
constexpr double kThinShare = 0.01;        // of the area

template <typename... Values>
std::string sentence(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

void warn_of_stretch(const Cloth& cloth, Report& report) {
  const bool woven = !cloth.fabrics.empty() && std::all_of(cloth.fabrics.begin(), cloth.fabrics.end(),
                                                           [](const Fabric& fabric) { return fabric.woven; });
  const double stretch = std::max(report.stretch_warp.p99, report.stretch_weft.p99);
  if (woven && stretch > kOverstretched)
    report.warnings.push_back(
        sentence("over-stretched: 1 %% of the woven fabric is stretched by more than %.1f %%", 100 * stretch));
  if (report.compressed_share > kCompressedShare)
    report.warnings.push_back(
        sentence("compressed beyond the model: %.1f %% of the cloth is squeezed below 0.577 of its "
                 "length, where only a barrier resists: is the mesh too coarse to fold?",
                 100 * report.compressed_share));
}

void warn_of_contact(Report& report) {
  if (report.self_intersections > 0)
    report.warnings.push_back(
        sentence("the cloth passes through itself at %ld pairs of triangles", report.self_intersections));
  if (report.penetration_max > kDeepPenetration)
    report.warnings.push_back(sentence("the cloth is %.1f mm inside the body", 1000 * report.penetration_max));
}

/// Where layers touch that are thin beside their triangles, few features of one meet the other.
void warn_of_thin_layers(const Cloth& cloth, const std::vector<double>& contact_distance, Report& report) {
  if (report.contacts.cloth == 0 || contact_distance.empty()) return;
  double thin = 0, total = 0, thinnest = 1;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const auto& flat = cloth.flat[t];
    const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0];
    const double area = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    const double edge = (a.norm() + b.norm() + (b - a).norm()) / 3;
    double distance = contact_distance[cloth.triangles[t][0]];
    for (int v : cloth.triangles[t]) distance = std::min(distance, contact_distance[v]);
    total += area;
    if (distance >= kThinLayer * edge) continue;
    thin += area;
    thinnest = std::min(thinnest, distance / edge);
  }
  if (thin > kThinShare * total)
    report.warnings.push_back(
        sentence("thin layers: cloth touches cloth, and on %.0f %% of it contact begins nearer than a tenth of an edge "
                 "(down to %.3f): layers rest on few points of each other",
                 100 * thin / total, thinnest));
}

void warn_of_unrest(Report& report) {
  if (report.residual_rms > kLargeResidual)
    report.warnings.push_back(
        sentence("not at rest: forces do not balance, rms residual %.2f of the nodal weight", report.residual_rms));
}

}  // namespace

void add_warnings(const Cloth& cloth, const std::vector<double>& contact_distance, Report& report) {
  warn_of_stretch(cloth, report);
  warn_of_contact(report);
  warn_of_thin_layers(cloth, contact_distance, report);
  warn_of_unrest(report);
}

}  // namespace toile
