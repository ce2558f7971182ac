#pragma once
// What a drape is worth: the numbers of schemas/report.schema.json, in SI units and fractions.

#include "engine/experiment_report.h"

#include <optional>
#include <string>
#include <vector>

namespace toile {

/// Of the stretch ratio minus one (0.02 = 2 %) over triangles: mean and percentiles by rest area, largest and smallest.
struct StretchStatistics {
  double mean = 0, p99 = 0, max = 0;
  double min = 0, p01 = 0, median = 0;
};

/// What one term of the model stores; `term` is its name in terms/ and in the report.
struct TermEnergy {
  std::string term;
  double energy = 0;  ///< [J]
};

/// Contacts that press, and those of them whose friction is inside its cone.
struct ContactStatistics {
  long body = 0, cloth = 0;
  long body_sticking = 0, cloth_sticking = 0;
};

struct StageTimes {
  double assemble = 0, drape = 0, render = 0, total = 0;                                               ///< wall [s]
  double collisions = 0, derivatives = 0, assembly = 0, linear_solve = 0, line_search = 0, other = 0;  ///< of drape
};

struct Report {
  std::string status;       ///< "converged", "not_converged", "cancelled", "failed"
  std::string stop_reason;  ///< "at_rest", "time_limit", "step_too_small", "seams_open", …
  long vertices = 0, triangles = 0;
  StageTimes time;
  double simulated_time = 0;
  long steps = 0, newton_iterations = 0, cg_iterations = 0, splits = 0, limited_vertices = 0;
  StretchStatistics stretch_warp, stretch_weft, stretch_bias;
  double residual_rms = 0, residual_max = 0;  ///< net force on free nodes over nodal weight
  double penetration_max = 0;                 ///< deepest point of the cloth inside the body [m]
  long self_intersections = 0;                ///< pairs of triangles
  double seam_gap_max = 0;                    ///< [m] before merging
  double kinetic_energy = 0;                  ///< [J]
  std::vector<TermEnergy> energies;           ///< by term
  ContactStatistics contacts;
  double discretisation_error = 0;  ///< estimated mean distance to the drape on a mesh of no edge length [m]
  double compressed_share = 0;      ///< of the rest area, squeezed farther than StVK reaches
  std::string result_sha256;        ///< of the final positions' bytes
  std::vector<std::string> warnings;
  std::optional<ExperimentReport> experiment;  ///< where the run was one
};

}  // namespace toile
