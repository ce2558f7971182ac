#pragma once
// Rigid trims in the system: two nodes each after those of the cloth, the centre and the rotation.

#include "engine/linear/block_matrix.h"
#include "engine/solve/trimmings.h"

namespace toile {

/// Within a step the rotation's unknown is x = ρ θ with R = exp([θ]×) R₀ (0 at the step's start), its velocity ρ ω, so
/// that x = h v as for every other node. Backward Euler in the conserved quantities:
///   m (v − v₀) = h F,   I(R) ω − I(R₀) ω₀ = h τ,
/// which leaves angular momentum as it is in free flight. Of the left side's derivative the gyroscopic part, not
/// symmetric and of the order of h |ω| beside I, is left out of the matrix, as is that of R(h ω): the residual is
/// exact. Few stencils, summed one after another.
class TrimSystem {
 public:
  /// `place` maps the cloth's vertices to the solver's nodes; trim t has the nodes place.size() + 2 t and + 1.
  TrimSystem(const Trimmings& trimmings, const std::vector<int>& place);

  int trims() const { return static_cast<int>(bodies_.size()); }
  int center_node(int trim) const { return first_node_ + 2 * trim; }
  int rotation_node(int trim) const { return first_node_ + 2 * trim + 1; }
  /// Five nodes a spring, for the matrix' topology.
  const std::vector<int>& stencil_nodes() const { return stencil_nodes_; }
  void find_slots(const BlockMatrix& topology);

  /// Sets where the step starts and appends its nodes' positions and velocities. Throws
  /// std::invalid_argument for another number of trims.
  void begin_step(const std::vector<RigidState>& start, Positions& x0, Positions& v0);
  /// Where the nodes say that the trims are.
  std::vector<RigidState> states(const Positions& x, const Positions& v) const;

  /// Adds the springs' forces [N]; on rotations torque over ρ.
  void add_forces(const Positions& x, const Positions& v, double fabric_factor, Positions& force) const;
  /// The same with their share of the matrix and the trims' inertia (with drag, in 1/s).
  void add_forces_and_matrix(const Positions& x, const Positions& v, const SystemWeights& weights, double air_drag,
                             Positions& force, BlockMatrix& matrix) const;
  /// The rest of the momentum balance of the trims' nodes, to be called with the forces summed up:
  ///   b = M (v₀ − v) + h (force + weight − drag), with the rotation's as above, over ρ; `weight` is a share of the
  ///   whole.
  void residual(const Positions& x, const Positions& v, double h, double air_drag, double weight,
                const Positions& force, Positions& b) const;

  double energy(const Positions& x) const;  ///< of the springs [J]
  Mat3 orientation(int trim, const Positions& x) const;
  const std::vector<RigidBody>& bodies() const { return bodies_; }

 private:
  AttachmentState attachment(const AttachmentStencil& s, const Positions& x) const;
  std::array<int, 5> nodes_of(const AttachmentStencil& s) const;

  int first_node_;
  std::vector<RigidBody> bodies_;
  std::vector<AttachmentStencil> attachments_;  ///< cloth nodes in the solver's numbering
  std::vector<int> stencil_nodes_;
  std::vector<std::array<int, 25>> slots_;
  std::vector<RigidState> start_;
};

}  // namespace toile
