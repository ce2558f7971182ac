#pragma once
// Sentences about what a reader of a report should not overlook.

#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"
#include "engine/scene/solver_options.h"

#include <vector>

namespace toile {

/// Appends to report.warnings what the report's numbers and the cloth give cause to: over-stretched, compressed beyond
/// the model, through itself, inside the body, not at rest, layers that are thin or nearer than they should be, a mesh
/// too coarse for its fabric. `contact_distance` is where cloth repels cloth, per vertex [m], and `asked_distance`
/// where it was asked to, 0: nothing was asked.
void add_warnings(const Cloth& cloth, const std::vector<double>& contact_distance, const SolverOptions& options,
                  Report& report);

/// Which garments are meant to be on the body, and how near they then come.
struct NearBody {
  std::vector<char> garments;  ///< per garment; 0: it hangs by pins of its own
  double offset = 0;           ///< how far contact keeps cloth off the body [m]
};

/// Of garments that come nowhere near the body, and of those whose `attached` vertices (Pin with PinAttached) are held
/// far from it on the average: they were placed for another body, or the body was placed for other garments.
void warn_of_far_garments(const Cloth& cloth, const BodyField& body, const std::vector<int>& attached,
                          const NearBody& near, Report& report);

}  // namespace toile
