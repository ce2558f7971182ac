#pragma once
// Draws the zones of seams apart that went through themselves while the seams closed.

#include "engine/solve/sew.h"

namespace toile {

/// Goes on with closed seams until nothing crosses: bending across the seams lays their sides flat beside each other,
/// what is still through something is drawn out along the curve in which it crosses (untangle.h), and what keeps
/// crossing is laid anew (fairing.h). Features near what crosses ignore each other meanwhile; nothing else can cross.
/// Returns the pairs of triangles that cross in the end; 0: sound.
std::size_t untangle_seams(AssemblyStage& stage, const Sewing& sewing, Cloth& cloth);

}  // namespace toile
