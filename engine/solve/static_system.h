#pragma once
// Everything of a cloth whose topology never changes: masses, membrane, bending, and their matrix.

#include "engine/linear/block_matrix.h"
#include "engine/linear/coloring.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"
#include "engine/solve/trim_system.h"
#include "engine/terms/bending.h"
#include "engine/terms/membrane.h"

namespace toile {

/// The list of terms with static stencils, in the node order of the solver (reverse Cuthill–McKee), with their colours
/// and their slots in the matrix (the first seed's §6.1, 6.4, 6.5). Positions and velocities here are in that order. A
/// new term is one more list here and one more line in each of the functions.
class StaticSystem {
 public:
  /// Throws std::invalid_argument for a cloth with a triangle of no flat area.
  /// Rigid trims add their nodes after the cloth's, and what their springs couple; zippers their tapes' mass.
  explicit StaticSystem(const Cloth& cloth, const Trimmings& trimmings = {});

  int nodes() const { return static_cast<int>(mass_.size()); }  ///< of the cloth
  int unknowns() const { return topology_.rows(); }             ///< with those of trims, which come after
  TrimSystem& trims() { return trims_; }
  const TrimSystem& trims() const { return trims_; }
  const std::vector<int>& order() const { return order_; }   ///< solver's index → cloth's
  const std::vector<int>& place() const { return place_; }   ///< cloth's index → solver's
  const std::vector<double>& mass() const { return mass_; }  ///< [kg]

  /// Sets `force` [N], of all unknowns, to the cloth's internal forces, elastic and dissipative.
  void forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const;
  /// The same, and sets `matrix` to Σ stiffness · ∂²E/∂x² + dissipation · ∂²R/∂v², positive semi-definite.
  void forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights, Positions& force,
                         BlockMatrix& matrix) const;
  /// A matrix of the topology with zero values.
  BlockMatrix make_matrix() const;

  std::vector<TermEnergy> energies(const Positions& x) const;  ///< of every term, in the order of their lists
  double membrane_energy_sum(const Positions& x) const;        ///< [J]
  double bending_energy_sum(const Positions& x) const;         ///< [J], of bending friction what it gives back

  /// The fabrics' damping is this share of what they were made with.
  void set_damping(double factor);

  /// Lets bending friction slide as far as it did in a step that ended at x.
  void advance_slip(const Positions& x);

 private:
  const BendingLaw* law_of(int stencil) const { return bending_.laws.empty() ? nullptr : &bending_.laws[stencil]; }

  std::vector<int> order_, place_;
  std::vector<double> mass_;
  std::vector<MembraneStencil> membrane_;  ///< in coloured order, nodes in the solver's order
  BendingStencils bending_;
  ColoredStencils membrane_colors_, bending_colors_;
  std::vector<std::array<int, 6>> membrane_slots_;  ///< (0,1) (0,2) (1,2) and their mirrors
  std::vector<std::array<int, 36>> bending_slots_;
  double damping_ = 1;
  TrimSystem trims_;
  BlockMatrix topology_;
};

}  // namespace toile
