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

/// Deepest of the cloth's mid-surface: triangles that may be deeper than what was found (whose barycentre is no farther
/// from there than their corners are from it) are sampled every millimetre, at eight places an edge at least and 256 at
/// most, and the deepest sample is improved to a micrometre where the body is smooth, to 0.2 mm at its sharp edges. So
/// what is narrower than a millimetre may be missed. Safe to call from many threads; the same on any number of threads.
Penetration deepest_penetration(const BodyField& body, const Positions& x, const std::vector<Triangle>& triangles);

}  // namespace toile
