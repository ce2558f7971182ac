#pragma once
// Which vertices the scene's pins hold, and where they are at a time.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

#include <vector>

namespace toile {

/// Vertices of garment `g` that a pin selects, in the numbering of `cloth` (apart or sewn). Empty: selects nothing.
/// Throws InputError (`vertex_out_of_range`) for a vertex that the garment does not have.
std::vector<int> pinned_vertices(const Pin& pin, int garment, const Cloth& cloth);

/// One held vertex: where it started and the motion it follows (none: it stays).
struct HeldVertex {
  int vertex;
  Vec3 start;
  const PinMoved* motion;  ///< points into the scene; null: fixed
  bool clamped = false;    ///< the tangent is held, too (solve/clamps.h)
};

/// Every vertex that the scene's pins hold; where two pins hold one vertex, the first pin's motion counts. `attached`
/// lists the vertices of pins that hold to the body. Throws InputError (`pin_selects_nothing`).
std::vector<HeldVertex> held_vertices(const Scene& scene, const Cloth& sewn, const std::vector<int>& attached);

/// Position at time t [s]: rotated about the pivot, then translated, linearly between key frames.
Vec3 position_at(const HeldVertex& held, double t);

/// The time of the last key frame of all [s]; 0: nothing moves.
double last_key_frame(const std::vector<HeldVertex>& held);

}  // namespace toile
