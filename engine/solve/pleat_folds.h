#pragma once
// Where a flat panel is to be folded: its pleats, told from its seams.

#include "engine/mesh/cloth.h"

#include <vector>

namespace toile {

/// A line in the panel's plane; `beyond` is a unit normal to it, to the side that folding moves.
struct Line {
  Vec3 at, beyond;
  double side(const Vec3& p) const { return beyond.dot(p - at); }
  Vec3 mirrored(const Vec3& p) const { return p - 2 * side(p) * beyond; }
};

/// Two folds of one pleat, the first before the second along the outline.
struct Pleat {
  Line first, second;
  double depth = 0;  // between them [m]
};

/// The pleats along one loop of a panel's outline, in its order. A pair of `own` (seam pairs within the panel) that
/// joins two places of the outline between which it runs straight maps it onto itself about their middle: a fold, if
/// deeper than half an `edge_length` [m]. Two folds beside each other that are as deep as they are apart make a pleat.
/// `normal` is the panel's. Darts, whose sides meet at a tip, and single tucks are none.
std::vector<Pleat> find_pleats(const std::vector<int>& loop, const Positions& x, const std::vector<SeamPair>& own,
                               const Vec3& normal, double edge_length);

}  // namespace toile
