#pragma once
// Clamps: held vertices along which the cloth's tangent is held, too.

#include "engine/solve/pin_motion.h"

#include <vector>

namespace toile {

/// Fills cloth.clamps with the mesh edges between two clamped vertices that have free cloth on a side. Where the
/// triangle across is clamped as a whole, it holds. Elsewhere (a panel's edge, or a line through the cloth) a point is
/// added to cloth.x, in no triangle, after the cloth's own vertices: the mirror image of the free triangle's tip, in
/// its plane as it lies now, or, with free cloth on both sides, in the plane of their mean. Returns these points as
/// held vertices that move with the edge. A clamp is where the line of clamped edges is: rows that the mesh does not
/// have, such as a box that cuts through triangles, clamp along a zigzag.
std::vector<HeldVertex> add_clamps(Cloth& cloth, const std::vector<HeldVertex>& held);

}  // namespace toile
