#pragma once
// Lumped masses.

#include "engine/mesh/cloth.h"

namespace toile {

/// Per vertex [kg]: a third of each triangle's flat area times its fabric's area density. A vertex of no triangle has
/// 0.
std::vector<double> lumped_masses(const Cloth& cloth);

}  // namespace toile
