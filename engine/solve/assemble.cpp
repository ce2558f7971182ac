#include "engine/solve/assemble.h"

#include "engine/mesh/sewing.h"
#include "engine/monitor.h"
#include "engine/solve/clear_panels.h"
#include "engine/solve/position_based.h"

#include <algorithm>
#include <limits>
#include <set>

namespace toile {
namespace {

constexpr double kClosedGap = 1e-4;     // [m] a seam is closed here; vertices then meet in their mean
constexpr double kReportedGap = 1e-3;   // [m] a seam wider than this after all steps is open
constexpr int kClosingSteps = 1500;     // at most, per garment
constexpr int kRelaxingSteps = 150;     // after closing: evens out the stretch of the closing
constexpr int kFallingSteps = 400;      // a skirt sewn through raised arms falls below them
constexpr double kListRadius = 12e-3;   // [m] wide: panels travel far

struct Stage {
  const Scene& scene;
  const AssemblyProgress& progress;
  long steps = 0;

  double step(PositionBased& solver, Positions& x, const PositionBasedOptions& options, double fraction) {
    const double gap = solver.step(x, options);
    ++steps;
    if (!progress({fraction, gap, solver.largest_move(), solver.contacts(), &x})) throw Cancelled{};
    return gap;
  }
};

double body_offset(const Cloth& cloth, const SolverOptions& solver) {
  if (solver.body_offset > 0) return solver.body_offset;
  double offset = 0;
  for (const ClothPanel& panel : cloth.panels)
    offset = std::max(offset, default_contact_distance(cloth.fabrics[panel.fabric].thickness, panel.edge_length));
  return offset;
}

/// Closes the seams of one garment while later garments wait and earlier ones give way.
void close_seams(Stage& stage, PositionBased& solver, Cloth& cloth, int garment, double offset, double from, double to) {
  solver.pulls.clear();
  for (const SeamPair& pair : cloth.seam_pairs)
    if (cloth.vertex_garment[pair.a] == garment) solver.pulls.push_back({pair.a, pair.b});
  if (solver.pulls.empty()) return;
  PositionBasedOptions options;
  options.body_offset = offset;
  double gap = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kClosingSteps && gap > kClosedGap; ++s)
    gap = stage.step(solver, cloth.x, options, from + (to - from) * 0.8 * s / kClosingSteps);
  options.carry = 0.5;
  options.closing = 2e-3;
  for (int s = 0; s < kRelaxingSteps; ++s) {
    gap = stage.step(solver, cloth.x, options, from + (to - from) * (0.8 + 0.2 * s / kRelaxingSteps));
    if (gap < kClosedGap && solver.largest_move() < 1e-4) break;
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
    limit_displacements(cloth.x, solver.displacement_bounds(cloth.x), target);
    cloth.x = target;
  }
  return gap_before;
}

/// Lets what was sewn through the arms fall below them, then minds the whole body.
void fall_clear(Stage& stage, Cloth& cloth, const std::vector<const BodyField*>& field_apart,
                const std::vector<int>& old_to_new, const BodyFields& fields, const std::vector<char>& keep,
                const std::vector<char>& held, double offset) {
  std::vector<const BodyField*> field(cloth.x.size(), fields.whole);
  bool any = false;
  for (std::size_t v = 0; v < field_apart.size(); ++v)
    if (field_apart[v] == fields.without_overhangs) field[old_to_new[v]] = fields.without_overhangs;
  for (std::size_t v = 0; v < cloth.x.size(); ++v)
    any = any || (field[v] != fields.whole && fields.whole->distance(cloth.x[v]) < offset);
  if (!any) return;
  PositionBasedOptions options;
  options.body_offset = offset;
  options.carry = 0.98;
  options.fall = {0, -0.05e-3, 0};
  const auto run = [&](const std::vector<const BodyField*>& minded, int steps) {
    PositionBased solver(cloth, make_collision_mesh(cloth, stage.scene.solver.contact_distance), kListRadius, minded);
    solver.keep_height = keep;
    for (std::size_t v = 0; v < held.size(); ++v)
      if (held[v]) solver.mobility[v] = 0;
    for (int s = 0; s < steps; ++s) stage.step(solver, cloth.x, options, 0.9 + 0.1 * s / steps);
  };
  run(field, kFallingSteps);
  run(std::vector<const BodyField*>(cloth.x.size(), fields.whole), kFallingSteps / 4);
}

}  // namespace

std::vector<int> pinned_vertices(const Pin& pin, int garment, const Cloth& cloth) {
  std::vector<int> chosen;
  const auto by_label = [&](const std::string& label) {
    for (const LabelledVertices& l : cloth.labels)
      if (l.garment == garment && l.label == label) chosen.insert(chosen.end(), l.vertices.begin(), l.vertices.end());
  };
  if (const auto* vertices = std::get_if<PinVertices>(&pin.select)) {
    int first = 0;  // a garment's vertices follow one another
    while (first < static_cast<int>(cloth.x.size()) && cloth.vertex_garment[first] != garment) ++first;
    for (int v : vertices->vertices) chosen.push_back(first + v);
  } else if (const auto* edge = std::get_if<PinEdge>(&pin.select)) {
    int index = 0;
    for (const ClothPanel& panel : cloth.panels)
      if (panel.garment == garment && index++ == edge->panel) by_label(panel.name + "/" + std::to_string(edge->edge));
  } else if (const auto* label = std::get_if<PinLabel>(&pin.select)) {
    by_label(label->label);
  } else if (const auto* box = std::get_if<PinBox>(&pin.select)) {
    for (std::size_t v = 0; v < cloth.x.size(); ++v)
      if (cloth.vertex_garment[v] == garment && (cloth.x[v].array() >= box->min.array()).all() &&
          (cloth.x[v].array() <= box->max.array()).all())
        chosen.push_back(static_cast<int>(v));
  } else if (const auto* nearest = std::get_if<PinNearest>(&pin.select)) {
    double best = std::numeric_limits<double>::infinity();
    int found = -1;
    for (std::size_t v = 0; v < cloth.x.size(); ++v) {
      const double d = (cloth.x[v] - nearest->point).squaredNorm();
      if (cloth.vertex_garment[v] == garment && d < best) best = d, found = static_cast<int>(v);
    }
    if (found >= 0) chosen.push_back(found);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

Assembly assemble(const Scene& scene, Cloth apart, const BodyFields& fields, const AssemblyProgress& progress) {
  Stage stage{scene, progress};
  Assembly result;
  const std::vector<const BodyField*> field = field_of_vertices(apart, fields);
  const double offset = body_offset(apart, scene.solver);
  std::vector<char> keep(apart.x.size(), 0), held(apart.x.size(), 0);
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (const Pin& pin : scene.garments[g].pins)
      for (int v : pinned_vertices(pin, static_cast<int>(g), apart))
        (std::holds_alternative<PinAttached>(pin.hold) ? keep : held)[v] = 1;

  if (!apart.seam_pairs.empty()) {
    clear_panels(apart, field, offset, 0.4);
    PositionBased solver(apart, make_collision_mesh(apart, scene.solver.contact_distance), kListRadius, field);
    solver.keep_height = keep;
    const int garments = static_cast<int>(scene.garments.size());
    for (int g = 0; g < garments; ++g) {
      for (std::size_t v = 0; v < apart.x.size(); ++v)
        solver.mobility[v] = held[v] || apart.vertex_garment[v] > g ? 0.0 : 1.0;
      close_seams(stage, solver, apart, g, offset, 0.9 * g / garments, 0.9 * (g + 1) / garments);
    }
    std::set<int> open;
    for (const SeamPair& pair : apart.seam_pairs)
      if ((apart.x[pair.a] - apart.x[pair.b]).norm() > kReportedGap) open.insert(pair.seam);
    for (int seam : open) result.open_seams.push_back(apart.seam_names[seam]);
    result.seam_gap_max = meet(solver, apart);
  }
  result.cloth = std::move(apart);
  result.old_to_new = merge_seams(result.cloth);
  std::vector<char> sewn_keep(result.cloth.x.size(), 0), sewn_held(result.cloth.x.size(), 0);
  for (std::size_t v = 0; v < result.old_to_new.size(); ++v) {
    if (result.old_to_new[v] < 0) continue;
    sewn_keep[result.old_to_new[v]] |= keep[v];
    sewn_held[result.old_to_new[v]] |= held[v];
  }
  if (fields.without_overhangs && result.open_seams.empty())
    fall_clear(stage, result.cloth, field, result.old_to_new, fields, sewn_keep, sewn_held, offset);
  for (std::size_t v = 0; v < sewn_keep.size(); ++v)
    if (sewn_keep[v]) result.attached.push_back(static_cast<int>(v));
  result.steps = stage.steps;
  return result;
}

}  // namespace toile
