#include "engine/solve/assemble.h"

#include "engine/mesh/sewing.h"
#include "engine/monitor.h"
#include "engine/quality/intersections.h"
#include "engine/scene/problem.h"
#include "engine/solve/body_parts.h"
#include "engine/solve/clear_panels.h"
#include "engine/solve/position_based.h"
#include "engine/solve/untangle.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace toile {
namespace {

constexpr double kClosedGap = 1e-4;     // [m] a seam is closed here; vertices then meet in their mean
constexpr double kReportedGap = 1e-3;   // [m] a seam wider than this after all steps is open
constexpr int kClosingSteps = 1500;     // at most, per garment
constexpr int kPatience = 150;          // steps without a smaller gap, after which a stage of the closing is over
constexpr int kRelaxingSteps = 150;     // after closing: evens out the stretch of the closing
constexpr int kUntanglingRounds = 200;  // at most: seam zones that went through each other come free
constexpr int kRoundsUntilLoosened = 25;
constexpr double kUntanglingStep = 2e-3;  // [m] per round

/// A way of sewing. Which one leads to no tangle can't be foreseen, so they are tried in this order, each from the
/// start.
struct Manner {
  double closing;  // of a gap per step [m]
  double carry;    // damped inertia
  SeamZone zone;   // where the two sides of a seam pass through each other
};
constexpr Manner kManners[] = {{6e-3, 0.6, {2, false}},
                               {3e-3, 0.85, {3, false}},
                               {3e-3, 0.6, {2, false}},
                               {6e-3, 0.85, {4, false}},
                               {2e-3, 0.7, {3, false}}};
constexpr SeamZone kWideZone{6, true};  // for seams that stay open
constexpr int kRidingSteps = 800;       // at most, of a waistband up the body
constexpr double kRidingStill = 3e-5;   // [m] per step
constexpr int kFallingSteps = 400;      // a skirt sewn through raised arms falls below them
constexpr double kSlitGap = 2e-4;       // [m]
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
    offset = std::max(offset, default_body_offset(cloth.fabrics[panel.fabric].thickness, panel.edge_length));
  return offset;
}

/// A tailor's order: first the seams that make tubes of each part (a torso, a sleeve), then those that join the parts,
/// so that a sleeve goes through its armhole as a whole and no corner of it is caught between two layers.
std::vector<std::vector<SeamPull>> seams_in_order(const Cloth& cloth, int garment,
                                                  const std::vector<std::string>& part) {
  std::vector<int> panel_of_vertex(cloth.x.size(), 0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int v : cloth.triangles[t]) panel_of_vertex[v] = cloth.triangle_panel[t];
  std::vector<SeamPull> within, all;
  for (const SeamPair& pair : cloth.seam_pairs) {
    if (cloth.vertex_garment[pair.a] > garment) continue;
    all.push_back({pair.a, pair.b});
    // What was sewn before stays so.
    if (cloth.vertex_garment[pair.a] < garment || part[panel_of_vertex[pair.a]] == part[panel_of_vertex[pair.b]])
      within.push_back({pair.a, pair.b});
  }
  if (within.size() == all.size()) return {all};
  return {within, all};
}

/// Closes the seams of one garment while later garments wait and earlier ones, kept closed, give way.
void close_seams(Stage& stage, PositionBased& solver, Cloth& cloth, int garment, const std::vector<std::string>& part,
                 const Manner& manner, double offset, double from, double to) {
  PositionBasedOptions options;
  options.body_offset = offset;
  options.closing = manner.closing;
  options.carry = manner.carry;
  double gap = 0;
  for (const std::vector<SeamPull>& pulls : seams_in_order(cloth, garment, part)) {
    solver.set_pulls(pulls);
    gap = std::numeric_limits<double>::infinity();
    double best = gap;
    int since_best = 0;
    for (int s = 0; s < kClosingSteps && gap > kClosedGap && since_best < kPatience; ++s) {
      gap = stage.step(solver, cloth.x, options, from + (to - from) * 0.8 * s / kClosingSteps);
      since_best = gap < 0.99 * best ? 0 : since_best + 1;
      best = std::min(best, gap);
    }
  }
  options.carry = 0.5;
  options.closing = 2e-3;
  for (int s = 0; s < kRelaxingSteps; ++s) {
    gap = stage.step(solver, cloth.x, options, from + (to - from) * (0.8 + 0.2 * s / kRelaxingSteps));
    if (gap < kReportedGap && solver.largest_move() < 1e-4) break;
  }
}

struct Sewing {
  const Scene& scene;
  const BodyFields& fields;
  const std::vector<const BodyField*>& field;
  const std::vector<char>&keep, &held;
  double offset;
};

/// The collision mesh of a sewn cloth in which the zones of its seams, given for the apart one, still pass through
/// each other.
CollisionMesh with_zones(const Cloth& sewn, const std::vector<int>& old_to_new, const CollisionMesh& apart,
                         double contact_distance) {
  CollisionMesh mesh = make_collision_mesh(sewn, contact_distance);
  std::vector<std::set<int>> zones(sewn.x.size());
  for (std::size_t v = 0; v < old_to_new.size(); ++v)
    if (old_to_new[v] >= 0) zones[old_to_new[v]].insert(apart.seam_zone[v].begin(), apart.seam_zone[v].end());
  for (const std::set<int>& zone : zones) mesh.seam_zone.emplace_back(zone.begin(), zone.end());
  return mesh;
}

/// What still crosses is held in place by its own contacts: within two edges around it, features ignore each other.
CollisionMesh loosened(CollisionMesh mesh, const std::vector<Triangle>& triangles,
                       const std::vector<TrianglePair>& crossings) {
  std::vector<char> loose(mesh.distance.size(), 0);
  for (const TrianglePair& pair : crossings)
    for (int t : {pair.a, pair.b})
      for (int v : triangles[t]) loose[v] = 1;
  for (int round = 0; round < 2; ++round) {
    const std::vector<char> before = loose;
    for (const auto& [a, b] : mesh.edges)
      if (before[a] || before[b]) loose[a] = loose[b] = 1;
  }
  constexpr int kLoose = -1;  // a zone of its own
  for (std::size_t v = 0; v < loose.size(); ++v)
    if (loose[v]) mesh.seam_zone[v].insert(mesh.seam_zone[v].begin(), kLoose);
  return mesh;
}

/// Goes on with closed seams until nothing crosses: bending across the seams lays their sides flat beside each other,
/// and what is still through something is drawn out. Returns the pairs of triangles that cross in the end.
std::size_t untangle(Stage& stage, const Sewing& sewing, Cloth& cloth, const CollisionMesh& zones) {
  Cloth sewn = cloth;
  const std::vector<int> old_to_new = merge_seams(sewn);
  std::vector<const BodyField*> field(sewn.x.size(), sewing.fields.whole);
  std::vector<char> keep(sewn.x.size(), 0);
  std::vector<double> mobility(sewn.x.size(), 1);
  for (std::size_t v = 0; v < old_to_new.size(); ++v) {
    const int w = old_to_new[v];
    if (w < 0) continue;
    if (sewing.field[v] != sewing.fields.whole) field[w] = sewing.field[v];
    keep[w] |= sewing.keep[v];
    if (sewing.held[v]) mobility[w] = 0;
  }
  const CollisionMesh mesh = with_zones(sewn, old_to_new, zones, sewing.scene.solver.contact_distance);
  std::optional<PositionBased> solver;
  const auto start_with = [&](const CollisionMesh& with) {
    solver.emplace(sewn, with, kListRadius, field);
    solver->keep_height = keep;
    solver->mobility = mobility;
  };
  start_with(mesh);
  PositionBasedOptions options;
  options.body_offset = sewing.offset;
  options.carry = 0.5;
  options.bending = 0.5;
  std::size_t crossing = 0;
  for (int s = 0;; ++s) {
    const std::vector<TrianglePair> crossings = self_intersections(sewn.x, sewn.triangles);
    crossing = crossings.size();
    if (crossings.empty() || s >= kUntanglingRounds) break;
    if (s > 0 && s % kRoundsUntilLoosened == 0) start_with(loosened(mesh, sewn.triangles, crossings));
    const Positions moves = untangling_moves(sewn.x, sewn.triangles, crossings, kUntanglingStep);
    Positions moved = sewn.x;
    for (std::size_t v = 0; v < sewn.x.size(); ++v)
      if (mobility[v] > 0) moved[v] += moves[v];
    limit_displacements(sewn.x, solver->displacement_bounds(sewn.x), moved);
    sewn.x = moved;
    for (int k = 0; k < 3; ++k) stage.step(*solver, sewn.x, options, 0.9);
  }
  for (std::size_t v = 0; v < old_to_new.size(); ++v)
    if (old_to_new[v] >= 0) cloth.x[v] = sewn.x[old_to_new[v]];
  return crossing;
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

std::vector<std::string> open_seams(const Cloth& cloth) {
  std::set<int> open;
  for (const SeamPair& pair : cloth.seam_pairs)
    if ((cloth.x[pair.a] - cloth.x[pair.b]).norm() > kReportedGap) open.insert(pair.seam);
  std::vector<std::string> names;
  for (int seam : open) names.push_back(cloth.seam_names[seam]);
  return names;
}

/// What one manner of sewing came to.
struct Sewn {
  Positions x;
  std::size_t open = 0, crossings = 0;
  double gap = 0;
  bool sound() const { return open == 0 && crossings == 0; }
  bool better_than(const Sewn& other) const {
    return std::make_pair(open, crossings) < std::make_pair(other.open, other.crossings);
  }
};

Sewn sew(Stage& stage, const Sewing& sewing, Cloth cloth, const Manner& manner) {
  const int garments = static_cast<int>(sewing.scene.garments.size());
  Sewn sewn;
  for (const SeamZone& zone : {manner.zone, kWideZone}) {
    const CollisionMesh mesh = make_collision_mesh(cloth, sewing.scene.solver.contact_distance, zone);
    PositionBased solver(cloth, mesh, kListRadius, sewing.field);
    solver.keep_height = sewing.keep;
    for (int g = 0; g < garments; ++g) {
      for (std::size_t v = 0; v < cloth.x.size(); ++v)
        solver.mobility[v] = sewing.held[v] || cloth.vertex_garment[v] > g ? 0.0 : 1.0;
      close_seams(stage, solver, cloth, g, part_of_panels(cloth, g, sewing.fields), manner, sewing.offset,
                  0.9 * g / garments, 0.9 * (g + 1) / garments);
    }
    sewn.open = open_seams(cloth).size();
    if (sewn.open > 0) continue;
    sewn.gap = meet(solver, cloth);
    sewn.crossings = untangle(stage, sewing, cloth, mesh);
    break;
  }
  if (sewn.open > 0) sewn.gap = seam_gap_max(cloth);
  sewn.x = std::move(cloth.x);
  return sewn;
}

/// What is tight where the pattern put it slides along the body, as it would in wear, to where it is less stretched: a
/// waistband finds its height before it is attached.
void ride_up(Stage& stage, Cloth& cloth, const std::vector<const BodyField*>& field, const std::vector<char>& keep,
             const std::vector<char>& held, double offset) {
  PositionBased solver(cloth, make_collision_mesh(cloth, stage.scene.solver.contact_distance), kListRadius, field);
  solver.keep_height = keep;
  for (std::size_t v = 0; v < held.size(); ++v)
    if (held[v]) solver.mobility[v] = 0;
  PositionBasedOptions options;
  options.body_offset = offset;
  options.carry = 0.95;
  for (int s = 0; s < kRidingSteps; ++s) {
    stage.step(solver, cloth.x, options, 0.9);
    if (s > kPatience && solver.largest_move() < kRidingStill) break;
  }
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
    for (int v : vertices->vertices) {
      if (v < 0 || first + v >= static_cast<int>(cloth.x.size()) || cloth.vertex_garment[first + v] != garment)
        throw InputError("/garments/" + std::to_string(garment) + "/pins", "vertex_out_of_range",
                         "a pin names vertex " + std::to_string(v) + ", which the garment does not have");
      chosen.push_back(first + v);
    }
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
    for (const Pin& pin : scene.garments[g].pins) {
      // Vertices are numbered as in the sewn mesh, which is yet to come.
      if (std::holds_alternative<PinVertices>(pin.select) && !apart.seam_pairs.empty()) continue;
      for (int v : pinned_vertices(pin, static_cast<int>(g), apart))
        (std::holds_alternative<PinAttached>(pin.hold) ? keep : held)[v] = 1;
    }

  if (!apart.seam_pairs.empty()) {
    center_sleeves(apart, fields);
    clear_panels(apart, field, offset, 0.4);
    open_slits(apart, kSlitGap);
    const Sewing sewing{scene, fields, field, keep, held, offset};
    std::optional<Sewn> best;
    for (const Manner& manner : kManners) {
      Sewn sewn = sew(stage, sewing, apart, manner);
      if (!best || sewn.better_than(*best)) best = std::move(sewn);
      if (best->sound()) break;
    }
    apart.x = std::move(best->x);
    result.open_seams = open_seams(apart);
    result.crossings = best->crossings;
    result.seam_gap_max = best->gap;
  } else {
    refuse_enclosed_panels(apart, field);
  }
  result.cloth = std::move(apart);
  result.old_to_new = merge_seams(result.cloth);
  std::vector<char> sewn_keep(result.cloth.x.size(), 0), sewn_held(result.cloth.x.size(), 0);
  for (std::size_t v = 0; v < result.old_to_new.size(); ++v) {
    if (result.old_to_new[v] < 0) continue;
    sewn_keep[result.old_to_new[v]] |= keep[v];
    sewn_held[result.old_to_new[v]] |= held[v];
  }
  if (stage.steps > 0 && result.open_seams.empty()) {
    std::vector<const BodyField*> sewn_field(result.cloth.x.size(), fields.whole);
    for (std::size_t v = 0; v < field.size(); ++v)
      if (result.old_to_new[v] >= 0 && field[v] != fields.whole) sewn_field[result.old_to_new[v]] = field[v];
    ride_up(stage, result.cloth, sewn_field, sewn_keep, sewn_held, offset);
  }
  if (fields.without_overhangs && result.open_seams.empty())
    fall_clear(stage, result.cloth, field, result.old_to_new, fields, sewn_keep, sewn_held, offset);
  for (std::size_t v = 0; v < sewn_keep.size(); ++v)
    if (sewn_keep[v]) result.attached.push_back(static_cast<int>(v));
  result.steps = stage.steps;
  return result;
}

}  // namespace toile
