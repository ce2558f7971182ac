#include "engine/solve/assemble.h"

#include "engine/mesh/sewing.h"
#include "engine/solve/body_parts.h"
#include "engine/solve/clear_panels.h"
#include "engine/solve/pin_motion.h"
#include "engine/solve/pleats.h"
#include "engine/solve/sew.h"
#include "engine/solve/sleeves.h"

#include <algorithm>
#include <numeric>

namespace toile {
namespace {

constexpr int kRidingSteps = 4000;     // at most, of a waistband up the body: the finer the mesh, the slower
constexpr int kSettlingSteps = 800;    // at most, of a garment that nothing attaches: weight decides where it goes
constexpr int kRidingStretch = 100;    // steps over which it is watched: it jitters more than it moves in one
constexpr double kRidingStill = 1e-3;  // [m] over that many
constexpr double kPush = 0.05e-3;      // [m] a step, of what falls or rises
constexpr int kFallingSteps = 400;     // a skirt sewn through raised arms falls below them
constexpr int kRisingSteps = 1000;     // at most
constexpr double kFallen = 0.98;       // progress
constexpr double kFootStep = 0.01;     // [m] between the heights where a foot is looked for
constexpr double kSlitGap = 2e-4;      // [m]
constexpr double kTouchGap = 1e-5;  // [m] the same of cloth that is not sewn, whose layers may be as near as they like
constexpr double kPressedGap = 1e-9;  // [m] folding has closed what is nearer

/// Whether a foot is over the point. What is less deep in one leaves it by the nearest way, which is upwards.
bool under_foot(const BodyFields& fields, const Vec3& point) {
  for (Vec3 p = point + kFootStep * Vec3::UnitY(); p.y() < fields.whole->ankle(); p.y() += kFootStep)
    if (fields.whole->distance(p) < 0) return fields.for_legs->distance(point) > 0;
  return false;
}

/// Trouser legs that were sewn round pointed toes are drawn up until no foot is in them. True if one was.
bool rise_clear(AssemblyStage& stage, PositionBased& solver, Positions& x, const PositionBasedOptions& options,
                const BodyFields& fields, const std::vector<const BodyField*>& field) {
  for (int s = 0; s < kRisingSteps; ++s) {
    bool any = false;
    for (std::size_t v = 0; v < x.size(); ++v) {
      const bool caught = field[v] == fields.for_legs && under_foot(fields, x[v]);
      solver.nudge[v] = caught ? Vec3(0, kPush, 0) : Vec3(0, 0, 0);
      any = any || caught;
    }
    if (!any) return s > 0;
    stage.step(solver, x, options, kFallen);
  }
  return true;
}

/// Lets skirts and trousers fall, below hands that they were sewn through and towards how they will hang, and rise
/// above feet; then they mind the whole body.
void clear_limbs(AssemblyStage& stage, Cloth& cloth, const std::vector<const BodyField*>& field_apart,
                 const std::vector<int>& old_to_new, const BodyFields& fields, const std::vector<char>& keep,
                 const std::vector<char>& held, double offset) {
  std::vector<const BodyField*> field(cloth.x.size(), fields.whole);
  bool any = false;
  for (std::size_t v = 0; v < field_apart.size(); ++v)
    if (old_to_new[v] >= 0 && field_apart[v] == fields.for_legs) field[old_to_new[v]] = fields.for_legs;
  for (std::size_t v = 0; v < cloth.x.size(); ++v)
    any = any ||
          (field[v] != fields.whole && (fields.whole->distance(cloth.x[v]) < offset || under_foot(fields, cloth.x[v])));
  if (!any) return;
  PositionBasedOptions falling;
  falling.body_offset = offset;
  falling.carry = 0.98;
  falling.fall = {0, -kPush, 0};
  PositionBasedOptions staying = falling;
  staying.fall.setZero();
  const auto solver_minding = [&](const std::vector<const BodyField*>& minded) {
    PositionBased solver(cloth, make_collision_mesh(cloth, stage.scene.solver.contact_distance), minded);
    solver.keep_height = keep;
    for (std::size_t v = 0; v < held.size(); ++v)
      if (held[v]) solver.mobility[v] = 0;
    return solver;
  };
  PositionBased dressing = solver_minding(field);
  for (int s = 0; s < kFallingSteps; ++s)
    stage.step(dressing, cloth.x, falling, 0.9 + (kFallen - 0.9) * s / kFallingSteps);
  const bool risen = rise_clear(stage, dressing, cloth.x, staying, fields, field);
  PositionBased dressed = solver_minding(std::vector<const BodyField*>(cloth.x.size(), fields.whole));
  for (int s = 0; s < kFallingSteps / 4; ++s) stage.step(dressed, cloth.x, risen ? staying : falling, 1);
}

/// What is tight where the pattern put it slides along the body, as it would in wear, to where it is less stretched: a
/// waistband finds its height before it is attached.
void ride_up(AssemblyStage& stage, Cloth& cloth, const std::vector<const BodyField*>& field,
             const std::vector<char>& keep, const std::vector<char>& held, double offset) {
  PositionBased solver(cloth, make_collision_mesh(cloth, stage.scene.solver.contact_distance), field);
  solver.keep_height = keep;
  for (std::size_t v = 0; v < held.size(); ++v)
    if (held[v]) solver.mobility[v] = 0;
  PositionBasedOptions options;
  options.body_offset = offset;
  options.carry = 0.95;
  const bool bands = std::any_of(keep.begin(), keep.end(), [](char k) { return k != 0; });  // they hold the rest
  const int most = bands ? kRidingSteps : kSettlingSteps;
  for (int s = 0; s < most; s += kRidingStretch) {
    const Positions before = cloth.x;
    for (int k = 0; k < kRidingStretch; ++k) stage.step(solver, cloth.x, options, 0.9);
    double farthest = 0;
    for (std::size_t v = 0; v < before.size(); ++v)
      if (!bands || keep[v]) farthest = std::max(farthest, (cloth.x[v] - before[v]).norm());
    if (farthest < kRidingStill) break;
  }
}

}  // namespace

Assembly assemble(const Scene& scene, Cloth apart, const BodyFields& fields, const AssemblyProgress& progress) {
  AssemblyStage stage{scene, progress};
  Assembly result;
  const bool sewn_from_panels = !apart.seam_pairs.empty();
  std::vector<std::string> part;
  std::vector<int> pressed(apart.x.size());  // vertex of the cloth as it came → of the one with its pleats closed
  std::iota(pressed.begin(), pressed.end(), 0);
  if (sewn_from_panels) {
    part = part_of_panels(apart, fields);
    fold_pleats(apart);
    center_sleeves(apart, part, fields);
    roll_tubes(apart, part, fields);
    pressed = merge_closed_seams(apart, kPressedGap);
  }
  const std::vector<const BodyField*> field = field_of_vertices(apart, fields);
  const double offset = largest_body_offset(apart, scene.solver.body_offset);
  std::vector<char> keep(apart.x.size(), 0), held(apart.x.size(), 0);
  for (std::size_t g = 0; g < scene.garments.size(); ++g)
    for (const Pin& pin : scene.garments[g].pins) {
      // Vertices are numbered as in the sewn mesh, which is yet to come.
      if (std::holds_alternative<PinVertices>(pin.select) && sewn_from_panels) continue;
      for (int v : pinned_vertices(pin, static_cast<int>(g), apart))
        (std::holds_alternative<PinAttached>(pin.hold) ? keep : held)[v] = 1;
    }

  if (sewn_from_panels) {
    clear_panels(apart, field, offset, 0.4);
    open_slits(apart, kSlitGap);
    refuse_coincident(apart);
    const Sewing sewing{scene, fields, field, keep, held, part, offset};
    Sewn sewn = sew(stage, sewing, apart);
    apart.x = std::move(sewn.x);
    result.open_seams = open_seams(apart);
    result.crossings = sewn.crossings;
    result.seam_gap_max = sewn.gap;
  } else {
    refuse_enclosed_panels(apart, field);
    open_slits(apart, kTouchGap);
    refuse_coincident(apart);
  }
  result.cloth = std::move(apart);
  const std::vector<int> merged = merge_seams(result.cloth);
  std::vector<char> sewn_keep(result.cloth.x.size(), 0), sewn_held(result.cloth.x.size(), 0);
  for (std::size_t v = 0; v < merged.size(); ++v) {
    if (merged[v] < 0) continue;
    sewn_keep[merged[v]] |= keep[v];
    sewn_held[merged[v]] |= held[v];
  }
  if (stage.steps > 0 && result.open_seams.empty()) {
    std::vector<const BodyField*> sewn_field(result.cloth.x.size(), fields.whole);
    for (std::size_t v = 0; v < field.size(); ++v)
      if (merged[v] >= 0 && field[v] != fields.whole) sewn_field[merged[v]] = field[v];
    ride_up(stage, result.cloth, sewn_field, sewn_keep, sewn_held, offset);
  }
  if (fields.for_legs && result.open_seams.empty())
    clear_limbs(stage, result.cloth, field, merged, fields, sewn_keep, sewn_held, offset);
  for (std::size_t v = 0; v < sewn_keep.size(); ++v)
    if (sewn_keep[v]) result.attached.push_back(static_cast<int>(v));
  for (const int v : pressed) result.old_to_new.push_back(v < 0 ? -1 : merged[v]);
  result.steps = stage.steps;
  return result;
}

}  // namespace toile
