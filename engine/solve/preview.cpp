#include "engine/solve/preview.h"

#include "engine/monitor.h"
#include "engine/solve/position_based.h"

#include <algorithm>

namespace toile {
namespace {

constexpr int kSteps = 1500;
constexpr double kStill = 2e-5;    // [m] per step
constexpr double kFriction = 0.3;  // where the body has none of its own

}  // namespace

PreviewOutcome settle_preview(const Scene& scene, Cloth& cloth, const BodyField* body,
                              const std::vector<HeldVertex>& held, const std::function<bool(double, long)>& progress) {
  PositionBased solver(cloth, make_collision_mesh(cloth, scene.solver.contact_distance),
                       std::vector<const BodyField*>(cloth.x.size(), body));
  PositionBasedOptions options;
  options.fall = {0, -0.05e-3, 0};
  options.carry = 0.97;
  options.body_offset = largest_body_offset(cloth, scene.solver.body_offset);
  if (scene.body) options.body_friction = scene.body->friction.value_or(kFriction);
  for (const HeldVertex& h : held) {
    solver.mobility[h.vertex] = 0;
    cloth.x[h.vertex] = position_at(h, last_key_frame(held));
  }
  PreviewOutcome outcome;
  while (outcome.steps < kSteps && !outcome.at_rest) {
    solver.step(cloth.x, options);
    ++outcome.steps;
    outcome.at_rest = outcome.steps > 50 && solver.largest_move() < kStill;
    if (!progress(static_cast<double>(outcome.steps) / kSteps, solver.contacts())) throw Cancelled{};
  }
  return outcome;
}

}  // namespace toile
