#include "engine/solve/sew.h"

#include "engine/mesh/sewing.h"
#include "engine/solve/approach.h"
#include "engine/solve/untangle_seams.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace toile {
namespace {

constexpr double kClosedGap = 1e-4;    // [m] a seam is closed here; vertices then meet in their mean
constexpr double kReportedGap = 1e-3;  // [m] a seam wider than this after all steps is open
constexpr int kClosingSteps = 1500;    // at most, per garment
constexpr int kPatience = 150;         // steps without a smaller gap, after which a stage of the closing is over
constexpr int kRelaxingSteps = 150;    // after closing: evens out the stretch of the closing

/// A way of sewing. Which one leads to no tangle can't be foreseen, so they are tried in this order, each from the
/// start.
struct Manner {
  double closing;  // of a gap per step [m]
  double carry;    // damped inertia
  SeamZone zone;   // where the two sides of a seam pass through each other
  bool slide;      // layers that are pressed together
};
constexpr Manner kManners[] = {
    {6e-3, 0.6, {2, false}, true},
    {6e-3, 0.6, {2, false}, false},
    {3e-3, 0.85, {3, false}, true},
    {6e-3, 0.85, {4, false}, true},
};
constexpr SeamZone kWideZone{6, true, kReportedGap};  // where seams stay open

/// A tailor's order: first darts, pleats and what else joins a panel to itself, then the seams that make tubes of each
/// part (a torso, a sleeve), then those that join the parts, so that a sleeve goes through its armhole as a whole and
/// no corner of it is caught between two layers.
std::vector<std::vector<SeamPull>> seams_in_order(const Cloth& cloth, int garment,
                                                  const std::vector<std::string>& part) {
  const std::vector<int> panel_of_vertex = panel_of_vertices(cloth);
  std::vector<std::vector<SeamPull>> stages(3);
  for (const SeamPair& pair : cloth.seam_pairs) {
    if (cloth.vertex_garment[pair.a] > garment) continue;
    const int p = panel_of_vertex[pair.a], q = panel_of_vertex[pair.b];
    // What was sewn before stays so.
    const std::size_t from = cloth.vertex_garment[pair.a] < garment || p == q ? 0 : part[p] == part[q] ? 1 : 2;
    for (std::size_t stage = from; stage < stages.size(); ++stage) stages[stage].push_back({pair.a, pair.b});
  }
  std::vector<std::vector<SeamPull>> distinct;
  for (std::vector<SeamPull>& pulls : stages)
    if (pulls.size() > (distinct.empty() ? 0 : distinct.back().size())) distinct.push_back(std::move(pulls));
  return distinct;
}

/// Closes the seams of one garment while later garments wait and earlier ones, kept closed, give way.
void close_seams(AssemblyStage& stage, PositionBased& solver, Cloth& cloth, int garment,
                 const std::vector<std::string>& part, const Manner& manner, double offset, double from, double to) {
  PositionBasedOptions options;
  options.body_offset = offset;
  options.closing = manner.closing;
  options.carry = manner.carry;
  options.slide = manner.slide;
  double gap = 0;
  for (const std::vector<SeamPull>& pulls : seams_in_order(cloth, garment, part)) {
    solver.set_pulls(pulls);
    gap = std::numeric_limits<double>::infinity();
    double best = gap;
    int since_best = 0;
    for (int s = 0; s < kClosingSteps && gap > kClosedGap && since_best < kPatience; ++s) {
      gap = stage.step(solver, cloth.x, options, from + (to - from) * 0.8 * s / kClosingSteps);
      ++since_best;
      if (gap < 0.99 * best) best = gap, since_best = 0;
    }
  }
  options.carry = 0.5;
  options.closing = 2e-3;
  for (int s = 0; s < kRelaxingSteps; ++s) {
    gap = stage.step(solver, cloth.x, options, from + (to - from) * (0.8 + 0.2 * s / kRelaxingSteps));
    if (gap < kReportedGap && solver.largest_move() < 1e-4) break;
  }
}

/// Seam vertices move into their common mean, never farther at once than nothing can cross.
double meet(PositionBased& solver, Cloth& cloth) {
  const std::vector<int> root = seam_representatives(cloth);
  const double gap_before = seam_gap_max(cloth);
  for (int round = 0; round < 100 && seam_gap_max(cloth) > 1e-9; ++round) {
    Positions sum(cloth.x.size(), Vec3::Zero());
    std::vector<int> count(cloth.x.size(), 0);
    for (std::size_t v = 0; v < cloth.x.size(); ++v) {
      sum[root[v]] += cloth.x[v];
      ++count[root[v]];
    }
    Positions target = cloth.x;
    for (std::size_t v = 0; v < cloth.x.size(); ++v)
      if (count[root[v]] > 1) target[v] = sum[root[v]] / count[root[v]];
    solver.limit_moves(cloth.x, target);
    cloth.x = target;
  }
  return gap_before;
}

bool better(const Sewn& a, const Sewn& b) {
  return std::make_pair(a.open, a.crossings) < std::make_pair(b.open, b.crossings);
}

Sewn sew_in(AssemblyStage& stage, const Sewing& sewing, Cloth cloth, const Manner& manner) {
  const int garments = static_cast<int>(sewing.scene.garments.size());
  Sewn sewn;
  for (const std::vector<SeamZone>& zones : {std::vector{manner.zone}, std::vector{manner.zone, kWideZone}}) {
    const CollisionMesh mesh = make_collision_mesh(cloth, sewing.scene.solver.contact_distance, zones);
    PositionBased solver(cloth, mesh, sewing.field);
    solver.keep_height = sewing.keep;
    for (int g = 0; g < garments; ++g) {
      for (std::size_t v = 0; v < cloth.x.size(); ++v)
        solver.mobility[v] = sewing.held[v] || cloth.vertex_garment[v] > g ? 0.0 : 1.0;
      approach(cloth, g, mesh, sewing.field, sewing.held);
      close_seams(stage, solver, cloth, g, sewing.part, manner, sewing.offset, 0.9 * g / garments,
                  0.9 * (g + 1) / garments);
    }
    sewn.open = open_seams(cloth).size();
    if (sewn.open > 0) continue;
    sewn.gap = meet(solver, cloth);
    sewn.crossings = untangle_seams(stage, sewing, cloth);
    break;
  }
  if (sewn.open > 0) sewn.gap = seam_gap_max(cloth);
  sewn.x = std::move(cloth.x);
  return sewn;
}

}  // namespace

std::vector<std::string> open_seams(const Cloth& cloth) {
  std::set<int> open;
  for (const SeamPair& pair : cloth.seam_pairs)
    if ((cloth.x[pair.a] - cloth.x[pair.b]).norm() > kReportedGap) open.insert(pair.seam);
  std::vector<std::string> names;
  for (int seam : open) names.push_back(cloth.seam_names[seam]);
  return names;
}

Sewn sew(AssemblyStage& stage, const Sewing& sewing, const Cloth& apart) {
  std::optional<Sewn> best;
  for (const Manner& manner : kManners) {
    Sewn sewn = sew_in(stage, sewing, apart, manner);
    if (!best || better(sewn, *best)) best = std::move(sewn);
    if (best->open == 0 && best->crossings == 0) break;
  }
  return std::move(*best);
}

}  // namespace toile
