#pragma once
// What a drape is worth: every number of the report that can be read off its final state.

#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"

#include <vector>

namespace toile {

/// Stretch, penetration (body may be null), self-intersections, counts and the hash of the final positions. Leaves
/// alone what only the run knows (times, iterations, residual, kinetic energy, status).
void measure_geometry(const Cloth& cloth, const BodyField* body, Report& report);

/// Net force over nodal weight: root mean square and largest, over vertices with mass that are not held (a zero net
/// force with `held`).
void measure_residual(const Positions& net_force, const std::vector<double>& mass, const std::vector<char>& held,
                      Report& report);

/// Sentences for the report about what a reader should not overlook.
void add_warnings(const Cloth& cloth, Report& report);

}  // namespace toile
