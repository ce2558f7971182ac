#pragma once
// Which vertices the scene's pins hold, and where they are at a time.

#include "engine/contact/sliding_contacts.h"
#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

#include <vector>

namespace toile {

/// Vertices of garment `g` that a pin selects, in the numbering of `cloth` (apart or sewn). Boxes and nearest points
/// are asked of where vertices were placed (Cloth::placed), so that the answer does not change as assembly moves them.
/// Empty: selects nothing. Throws InputError (`vertex_out_of_range`) for a vertex that the garment does not have.
std::vector<int> pinned_vertices(const Pin& pin, int garment, const Cloth& cloth);

/// Vertices of the sewn cloth that pins attach to the body so that they slide, each once (the first pin counts), with
/// the pin's friction, else that of the vertex's fabric on the body (contact/friction_table.h).
std::vector<SlidingVertex> sliding_vertices(const Scene& scene, const Cloth& cloth);

/// One held vertex: where it started and the motion it follows (none: it stays).
struct HeldVertex {
  int vertex;
  Vec3 start;
  const PinMoved* motion;  ///< points into the scene; null: fixed
  bool clamped = false;    ///< the tangent is held, too (solve/clamps.h)
};

/// Every vertex that the scene's pins hold; where two pins hold one vertex, the first pin's motion counts. `attached`
/// lists the vertices of pins that hold to the body, `sliding` those of them that are not held. Throws InputError
/// (`pin_selects_nothing`).
std::vector<HeldVertex> held_vertices(const Scene& scene, const Cloth& sewn, const std::vector<int>& attached,
                                      const std::vector<SlidingVertex>& sliding = {});

/// Position at time t [s]: rotated about the pivot, then translated, linearly between key frames.
Vec3 position_at(const HeldVertex& held, double t);

/// The time of the last key frame of all [s]; 0: nothing moves.
double last_key_frame(const std::vector<HeldVertex>& held);

}  // namespace toile
