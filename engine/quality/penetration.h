#pragma once
// How deep the cloth is inside the body.

#include "engine/geometry/body_field.h"
#include "engine/types.h"

#include <vector>

namespace toile {

struct Penetration {
  double depth = 0;           ///< [m], 0: no sample is inside
  Vec3 point = Vec3::Zero();  ///< the deepest sample
  int triangle = -1;          ///< that it lies on, -1: none is inside
};

/// Deepest of the cloth's mid-surface, sampled at vertices, edge midpoints and barycentres, and eight times finer along
/// each edge on triangles that may come near: those whose barycentre is no farther from the body than their corners are
/// from it. Safe to call from many threads; the same on any number of threads.
Penetration deepest_penetration(const BodyField& body, const Positions& x, const std::vector<Triangle>& triangles);

}  // namespace toile
