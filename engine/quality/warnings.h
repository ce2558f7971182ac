#pragma once
// Sentences about what a reader of a report should not overlook.

#include "engine/mesh/cloth.h"
#include "engine/report.h"

#include <vector>

namespace toile {

/// Appends to report.warnings what the report's numbers and the cloth give cause to: over-stretched, compressed beyond
/// the model, through itself, inside the body, not at rest, thin layers. `contact_distance` is where cloth repels
/// cloth, per vertex [m].
void add_warnings(const Cloth& cloth, const std::vector<double>& contact_distance, Report& report);

}  // namespace toile
