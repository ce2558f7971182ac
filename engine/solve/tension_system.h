#pragma once
// Elastics, drawcords and tapes in the solver's node order: their forces and their share of the system matrix.

#include "engine/linear/block_matrix.h"
#include "engine/linear/rank_one_matrix.h"
#include "engine/solve/trimmings.h"

namespace toile {

/// Few stencils beside the cloth's, so they are summed one after another, in a fixed order.
class TensionSystem {
 public:
  /// `place` maps the cloth's vertices to the solver's nodes; `topology` has every edge of the mesh and every pair of a
  /// tape's stencils.
  TensionSystem(const Trimmings& trimmings, const std::vector<int>& place, const BlockMatrix& topology);

  /// Adds the forces, elastic and dissipative [N].
  void add_forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const;
  /// The same, and adds what couples neighbours to `fixed`; what couples a whole cord is set in wide().
  void add_forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights, Positions& force,
                             BlockMatrix& fixed);
  /// Null without drawcords.
  RankOneMatrix* wide() { return cords_.empty() ? nullptr : &wide_; }

  bool any() const { return !elastics_.empty() || !cords_.empty() || !tapes_.empty(); }
  double energy(const Positions& x) const;  ///< [J]

 private:
  struct Cord {
    DrawcordStencil stencil;
    std::vector<int> nodes;                   ///< each once
    std::vector<std::array<int, 2>> members;  ///< per segment, places in nodes
    std::vector<std::array<int, 2>> slots;    ///< per segment
  };
  std::vector<ElasticStencil> elastics_;
  std::vector<std::array<int, 2>> elastic_slots_;
  std::vector<TapeStencil> tapes_;
  std::vector<std::array<int, 9>> tape_slots_;
  std::vector<Cord> cords_;
  RankOneMatrix wide_;
};

}  // namespace toile
