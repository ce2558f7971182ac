#include "engine/quality/warnings.h"

#include "engine/geometry/flat_triangle.h"
#include "engine/quality/stretch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace toile {
namespace {

constexpr double kOverstretched = 0.05;    // 99th percentile of a woven fabric's stretch
constexpr double kCompressedShare = 1e-3;  // of the area, squeezed beyond StVK
constexpr double kDeepPenetration = 2e-3;  // [m]
constexpr double kLargeResidual = 0.1;     // rms of the net force over nodal weight
constexpr double kRestResidual = 0.05;     // the same of what has not converged
constexpr double kThinLayer = 0.1;         // contact distance over edge length; layers meet few features of each other
constexpr double kThinShare = 0.01;        // of the area
constexpr double kCapped = 0.95;           // contact distance over what was wanted
constexpr double kLongEdge = 1.5;          // edge over the fabric's bending length
constexpr double kLongShare = 0.5;         // of the area
constexpr double kFarOff = 0.02;           // [m] from the body, all of a garment
constexpr double kFarHeld = 0.03;          // [m] from the body, what is attached to it, in the mean

template <typename... Values>
std::string sentence(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

void warn_of_stretch(const Cloth& cloth, Report& report) {
  TriangleStretch woven = triangle_stretch(cloth.flat, cloth.triangles, cloth.x);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    if (!cloth.fabrics[cloth.panels[cloth.triangle_panel[t]].fabric].woven) woven.area[t] = 0;
  const double stretch =
      std::max(stretch_statistics(woven.warp, woven.area).p99, stretch_statistics(woven.weft, woven.area).p99);
  if (stretch > kOverstretched)
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
    const double area = flat_area(cloth.flat[t]), edge = mean_edge(cloth.flat[t]);
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

/// Where triangles are too small for the distance that was asked for, or for the fabric's thickness (the least where
/// several meet).
void warn_of_capped_layers(const Cloth& cloth, const std::vector<double>& contact_distance, double asked,
                           Report& report) {
  if (report.contacts.cloth == 0 || contact_distance.empty()) return;
  std::vector<double> wanted(cloth.x.size(), asked > 0 ? asked : std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; asked <= 0 && t < cloth.triangles.size(); ++t)
    for (int v : cloth.triangles[t])
      wanted[v] = std::min(wanted[v], cloth.fabrics[cloth.panels[cloth.triangle_panel[t]].fabric].thickness);
  double capped = 0, total = 0, least = 1, wanted_there = 0;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const double share = flat_area(cloth.flat[t]) / 3;
    for (int v : cloth.triangles[t]) {
      total += share;
      if (contact_distance[v] >= kCapped * wanted[v]) continue;
      capped += share;
      if (contact_distance[v] < least) least = contact_distance[v], wanted_there = wanted[v];
    }
  }
  if (capped > kThinShare * total)
    report.warnings.push_back(
        sentence("near layers: on %.0f %% of the cloth its layers keep less than the %.1f mm that they should (down to "
                 "%.1f mm), for they keep no more than 0.3 of a triangle's smallest altitude",
                 100 * capped / total, 1e3 * wanted_there, 1e3 * least));
}

/// Edges that are long beside (D/(ρ g))^⅓ can't form the folds in which such cloth hangs: it stands off like a board.
void warn_of_long_edges(const Cloth& cloth, Report& report) {
  double edges = 0, lengths = 0, long_area = 0, total = 0;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const Fabric& fabric = cloth.fabrics[cloth.panels[cloth.triangle_panel[t]].fabric];
    const double area = flat_area(cloth.flat[t]), edge = mean_edge(cloth.flat[t]), length = bending_length(fabric);
    total += area;
    if (length <= 0 || edge <= kLongEdge * length) continue;
    long_area += area;
    edges += area * edge;
    lengths += area * length;
  }
  if (long_area > kLongShare * total)
    report.warnings.push_back(
        sentence("coarse mesh: edges of %.1f mm on a fabric of %.1f mm bending length can't fold as it would: shorter "
                 "ones would",
                 1e3 * edges / long_area, 1e3 * lengths / long_area));
}

void warn_of_unrest(Report& report) {
  const bool converged = report.status == "converged";
  if (report.residual_rms > (converged ? kLargeResidual : kRestResidual))
    report.warnings.push_back(
        sentence("not at rest: forces do not balance, rms residual %.2f of the nodal weight", report.residual_rms));
}

}  // namespace

void add_warnings(const Cloth& cloth, const std::vector<double>& contact_distance, const SolverOptions& options,
                  Report& report) {
  warn_of_stretch(cloth, report);
  warn_of_contact(report);
  warn_of_thin_layers(cloth, contact_distance, report);
  warn_of_capped_layers(cloth, contact_distance, options.contact_distance, report);
  if (options.gravity) warn_of_long_edges(cloth, report);
  warn_of_unrest(report);
}

void warn_of_far_garments(const Cloth& cloth, const BodyField& body, const std::vector<int>& attached,
                          const NearBody& near, Report& report) {
  const std::size_t garments = near.garments.size();
  std::vector<double> nearest(garments, std::numeric_limits<double>::infinity()), held(garments, 0.0);
  std::vector<int> count(garments, 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const auto& [a, b, c] = cloth.triangles[t];
    double& least = nearest[cloth.vertex_garment[a]];
    for (const Vec3& p : {cloth.x[a], cloth.x[b], cloth.x[c], Vec3((cloth.x[a] + cloth.x[b] + cloth.x[c]) / 3)})
      least = std::min(least, body.distance(p) - near.offset);
  }
  for (const int v : attached) {
    held[cloth.vertex_garment[v]] += body.distance(cloth.x[v]) - near.offset;
    ++count[cloth.vertex_garment[v]];
  }
  for (std::size_t g = 0; g < garments; ++g) {
    if (count[g] > 0 && held[g] > kFarHeld * count[g])
      report.warnings.push_back(sentence(
          "far from the body: what is attached of garment %zu is held over %.0f mm away from it on the average: "
          "does the garment's place fit the body's, with y up and the feet at y = 0?",
          g, std::floor(1e3 * held[g] / count[g])));
    else if (near.garments[g] && std::isfinite(nearest[g]) && nearest[g] > kFarOff)
      report.warnings.push_back(sentence("far from the body: garment %zu comes nowhere nearer to it than %.0f mm", g,
                                         std::floor(1e3 * nearest[g])));
  }
}

}  // namespace toile
