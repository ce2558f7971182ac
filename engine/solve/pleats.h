#pragma once
// Folds the pleats of flat panels before they are sewn, as a tailor presses them.

#include "engine/mesh/cloth.h"

namespace toile {

/// A pleat is told from the seams that join a panel to itself across a stretch of its own outline (pleat_folds.h): a Z
/// of three layers. Panels with such are folded without stretching, every layer beneath the one before it (the way of
/// the outline is upwards or downwards; knife pleats then look one way), and vertices that folding brings together
/// meet, so that the pleats are closed. Two pleats whose folds face each other come up again in the second, as a box
/// pleat's do, if the layers can't lie closed as knife pleats (its folds may be tacked to each other). Fold lines are
/// parallel, but in panels that are sewn to themselves elsewhere (sleeves) each pleat ends at the panel's other side.
/// Sewn from flat panels, layers would have to find their order by themselves. A panel stays flat where its triangles
/// are too coarse to be folded without crossing. Darts, whose sides meet at a tip, and single tucks are no pleats.
/// Deterministic.
void fold_pleats(Cloth& apart);

}  // namespace toile
