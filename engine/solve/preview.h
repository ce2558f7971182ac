#pragma once
// The fast rung: lets a sewn garment settle under gravity by positions alone.

#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"
#include "engine/solve/pin_motion.h"

#include <functional>
#include <vector>

namespace toile {

struct PreviewOutcome {
  long steps = 0;
  bool at_rest = false;  ///< movement died down before the limit on steps
};

/// Steps the position-based solver with a constant fall until nothing moves by more than 0.02 mm a step, at most 1,500
/// steps. Cloth crosses neither itself nor the body; lengths are kept, forces mean nothing. Calls progress(fraction,
/// contacts) each step; false throws Cancelled.
PreviewOutcome settle_preview(const Scene& scene, Cloth& cloth, const BodyField* body,
                              const std::vector<HeldVertex>& held, const std::function<bool(double, long)>& progress);

}  // namespace toile
