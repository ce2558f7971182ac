#pragma once
// What the laboratory's experiments measure, in SI units; part of the report.

#include <optional>
#include <variant>
#include <vector>

namespace toile {

/// One hanging of a Cusick specimen.
struct CusickStart {
  bool at_rest = false;                 ///< otherwise it is not counted
  double coefficient = 0;               ///< of this hanging, 0 to 1
  int nodes = 0;                        ///< folds of the shadow's outline
  double energy = 0;                    ///< stored, and of gravity against the level of the support [J]
  std::vector<double> node_amplitudes;  ///< harmonics 1, 2, … of the outline [m]
};

struct CusickReport {
  /// (A_shadow − A_support) / (A_disc − A_support), mean over the hangings at rest: 1 is a rigid disc.
  double coefficient = 0;
  double nodes = 0;  ///< their mean
  std::vector<CusickStart> starts;
};

struct CantileverReport {
  double overhang = 0;  ///< [m]
  double angle = 0;     ///< of the chord from the edge to the middle of the end, below the level [rad]
  /// Peirce's c = (D / (areal density · g))^(1/3) [m]: half the overhang where the chord falls by 41.5° (exact to
  /// 0.02 % for an elastic strip); none where the overhang was given.
  std::optional<double> bending_length;
  double drop = 0;  ///< of the end's middle below the edge [m]
};

struct UniaxialReport {
  struct Reading {
    double strain = 0, force = 0;  ///< elongation over rest length, force per rest width [N/m]
  };
  std::vector<Reading> curve;
  double shear_angle = 0;  ///< in the middle at the last strain: by how much warp and weft left the right angle [rad]
};

struct PearLoopReport {
  double height = 0;  ///< from the clamp down to the lowest point [m]; weightless: 0.4243 of the length
};

using ExperimentReport = std::variant<CusickReport, CantileverReport, UniaxialReport, PearLoopReport>;

}  // namespace toile
