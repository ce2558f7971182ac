#pragma once
// Folds the pleats of flat panels before they are sewn, as a tailor presses them.

#include "engine/mesh/cloth.h"

namespace toile {

/// A pleat is told from the seams that join a panel to itself across a stretch of its own outline: two folds beside
/// each other, of which each maps the outline onto itself, make a Z of three layers. Panels with such are folded along
/// parallel lines through those folds, without stretching, every layer beneath the one before it (the way of the
/// outline is upwards or downwards; knife pleats then look one way). Sewn from flat panels, the three layers would have
/// to find their order by themselves. A panel stays flat where its triangles are too coarse to be folded without
/// crossing. Darts, whose sides meet at a tip, and single tucks are no pleats. Deterministic.
void fold_pleats(Cloth& apart);

}  // namespace toile
