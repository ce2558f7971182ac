#pragma once
// What a fabric laboratory asks of a cloth, as plain structs in SI units; engine/experiments carries it out.

#include "engine/scene/fabric.h"
#include "engine/scene/problem.h"

#include <optional>
#include <variant>
#include <vector>

namespace toile {

/// How a specimen's length lies in the cloth; bias is 45°.
enum class Direction { warp, weft, bias };

/// engine/experiments/cusick_drape.h
struct CusickDrape {
  Fabric fabric;
  double disc_diameter = 0.30, support_diameter = 0.18;  ///< [m]
  double edge_length = 0.005;                            ///< of the mesh [m]
  int starts = 6;                                        ///< hangings of the one specimen
  double lowering_time = 8;  ///< in which the platform under the specimen is lowered [s]; 0: it drops
};

/// engine/experiments/cantilever.h
struct Cantilever {
  Fabric fabric;
  Direction direction = Direction::warp;
  double width = 0.025;                 ///< [m]
  std::optional<double> overhang = {};  ///< [m]; none: the one whose chord falls by 41.5°
  double edge_length = 0;  ///< of the mesh [m]; 0: a twelfth of the overhang, or a sixth of (D / (ρ g))^⅓
};

/// engine/experiments/uniaxial.h; along the bias: the bias-extension test
struct UniaxialTest {
  Fabric fabric;
  Direction direction = Direction::warp;
  double length = 0.2, width = 0.05;                       ///< between the grips, and of the strip [m]
  std::vector<double> strains = {0.01, 0.02, 0.03, 0.05};  ///< elongation over rest length, rising
  double edge_length = 0.005;                              ///< of the mesh [m]
};

/// engine/experiments/pear_loop.h
struct PearLoop {
  Fabric fabric;
  Direction direction = Direction::warp;
  double length = 0.15, width = 0.025;  ///< of the strip, between its clamped ends [m]
  double edge_length = 0;               ///< of the mesh [m]; 0: a sixtieth of the length
};

using Experiment = std::variant<CusickDrape, Cantilever, UniaxialTest, PearLoop>;

/// Everything that is wrong with it; pointers are the keys of experiment.schema.json below "". Codes: fabric_value,
/// experiment_value, strains_not_rising, too_many_vertices.
std::vector<Problem> experiment_problems(const Experiment& experiment);

}  // namespace toile
