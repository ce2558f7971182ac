#pragma once
// First half of a drape: from flat panels placed around a body to a sewn garment that wears it.

#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace toile {

/// The fields that the cloth minds. Null: no body.
struct BodyFields {
  const BodyField* whole = nullptr;
  const BodyField* without_overhangs = nullptr;  ///< without what hangs from above (arms, hands)
  /// That, with toes that point down: what panels of legs mind while they are sewn, as one raises one's arms to put on
  /// a skirt and points one's toes to get into trousers.
  const BodyField* for_legs = nullptr;
};

struct Assembly {
  Cloth cloth;                          ///< seams merged where they closed
  double seam_gap_max = 0;              ///< before merging [m]
  std::vector<std::string> open_seams;  ///< seams that did not close; empty: assembled
  std::size_t crossings = 0;            ///< pairs of triangles that cross at the end of the sewing; 0: sound
  long steps = 0;
  std::vector<int> attached;    ///< vertices of the sewn cloth that Pin::attached holds
  std::vector<int> old_to_new;  ///< vertex of the apart cloth → of the sewn one
};

struct AssemblyState {
  double fraction = 0;      ///< done, estimated
  double largest_gap = 0;   ///< of the seams being closed [m]
  double largest_move = 0;  ///< of any vertex in the step [m]
  long contacts = 0;        ///< cloth–cloth
  const Positions* x = nullptr;
};
/// Called once per step; false cancels (throws Cancelled).
using AssemblyProgress = std::function<bool(const AssemblyState&)>;

/// Panels that lie inside the body, or cross cloth that came before them, move out along their own normal, and only
/// they. Then seams close garment by garment, without gravity, by the position-based solver, which keeps cloth out of
/// the body and out of other cloth at every step; seam vertices become one. Deterministic.
Assembly assemble(const Scene& scene, Cloth apart, const BodyFields& fields, const AssemblyProgress& progress);

}  // namespace toile
