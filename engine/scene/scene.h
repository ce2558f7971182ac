#pragma once
// What is to be draped, as plain structs in SI units. Read from JSON by schemas/, checked by scene/check.h.

#include "engine/scene/body.h"
#include "engine/scene/fabric.h"
#include "engine/scene/friction.h"
#include "engine/scene/pattern.h"
#include "engine/scene/pin.h"
#include "engine/scene/solver_options.h"
#include "engine/scene/trim.h"
#include "engine/scene/zipper.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace toile {

/// A garment given as a mesh: UV is the flat pattern; stitches in the mesh, or pairs of vertices that are one.
struct GarmentMesh {
  TriangleMesh mesh;
  double uv_unit = 1.0;  ///< metres per UV unit
  std::vector<std::pair<int, int>> seams;
};

/// How a garment's seams bend: several layers lie in a seam.
struct SeamBending {
  double stiffness_factor = 1;  ///< of the cloth's own bending stiffness across the seam
};

/// Pressed in: a pleat's or a hem's fold, a seam ironed to one side.
struct Fold {
  std::variant<PinEdge, PinLabel, PinVertices> select;  ///< vertices: a chain of the garment's mesh, edge by edge
  double angle = 0;                                     ///< at rest [rad]; positive: a ridge seen from the right side
  double stiffness_factor = 1;                          ///< instead of the seam's, where the fold lies in one
};

struct Garment {
  std::string name;
  std::variant<Pattern, GarmentMesh> shape;
  Fabric fabric;
  std::map<std::string, Fabric> panel_fabrics;  ///< by panel (group) name, instead of `fabric`
  /// Where the warp runs in the flat pattern: counter-clockwise from +y (+v of a mesh), as the pattern is drawn [rad].
  double grain = 0;
  std::map<std::string, double> panel_grain;  ///< by panel (group) name, instead of `grain` [rad]
  double edge_length = 0.015;                 ///< target [m]; a mesh garment keeps its own
  std::vector<Pin> pins;
  SeamBending seam_bending;
  std::vector<Fold> folds;
  std::vector<Elastic> elastics;
  std::vector<Drawcord> drawcords;
  std::vector<Trim> trims;
  std::vector<Zipper> zippers;
};

/// The rung on the ladder of speed against accuracy. `preview` stops after the position-based solver.
enum class Fidelity { preview, standard, reference };

/// Garments in layer order, the innermost first.
struct Scene {
  std::vector<Garment> garments;
  std::optional<Body> body;
  std::vector<FrictionPair> friction_pairs;
  Fidelity fidelity = Fidelity::standard;
  SolverOptions solver;
};

/// Per garment, whether it came as a mesh and not as a pattern.
inline std::vector<char> given_as_mesh(const Scene& scene) {
  std::vector<char> given;
  for (const Garment& garment : scene.garments) given.push_back(std::holds_alternative<GarmentMesh>(garment.shape));
  return given;
}

}  // namespace toile
