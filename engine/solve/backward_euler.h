#pragma once
// One step of the accurate engine: backward Euler by Newton's method with line search (Algorithm 1 of the first seed,
// lines 8 to 36).

#include "engine/contact/contact.h"
#include "engine/mesh/cloth.h"
#include "engine/report.h"
#include "engine/scene/solver_options.h"
#include "engine/solve/trimmings.h"
#include "engine/terms/trim_contact.h"

#include <memory>

namespace toile {

/// Positions [m] and velocities [m/s], per vertex of the cloth, and the rigid trims in the order of the trimmings.
struct State {
  Positions x, v;
  std::vector<RigidState> trims = {};
};

/// Held vertices move to `target` by the end of the step, in a straight line; the others' targets are not read. Both
/// lists have one entry a vertex.
struct Kinematic {
  std::vector<char> held;
  Positions target;
};

struct StepOutcome {
  bool accepted = false;
  double residual = 0;  ///< ‖b‖ at the end [kg·m/s], over free vertices
  int newton_iterations = 0, cg_iterations = 0;
};

/// Wall time spent, added up over steps [s].
struct StepTimes {
  double derivatives = 0;   ///< forces and Hessians of static terms, accumulated into the matrix as they are made
  double assembly = 0;      ///< contacts' topology, forces and blocks, masses, preconditioner
  double linear_solve = 0;  ///< conjugate gradients
  double line_search = 0;   ///< the residual at trial points
};

/// Energies by term [J]; tension: of elastics, drawcords and tapes; attachment: of trims' springs;
/// gravity and kinetic with the trims' share.
struct Energies {
  double membrane = 0, bending = 0, tension = 0, attachment = 0, gravity = 0, contact = 0, kinetic = 0;
};

/// Solves  M (v − v₀) = h F(x₀ + h v, v)  for v (the seed's equation 1); Newton's method as its equation 4, with the
/// system matrix made positive definite term by term (terms/*.h). Holds what is computed once: node order, stencils,
/// colours, matrix topology and slots (§6.1, 6.4, 6.5). All arguments are in the cloth's vertex order. One call at a
/// time per object; results do not depend on the number of threads.
class BackwardEuler {
 public:
  /// Takes flat shapes, fabrics and topology of a sewn cloth, and what is sewn onto it; its positions are not read.
  /// Throws std::invalid_argument for a triangle of no flat area.
  BackwardEuler(const Cloth& sewn, const SolverOptions& options, const Trimmings& trimmings = {});
  ~BackwardEuler();
  BackwardEuler(BackwardEuler&&) noexcept;
  BackwardEuler& operator=(BackwardEuler&&) noexcept;

  /// One step of length h [s] with the fabrics' stiffness (and its damping) times `stiffness_factor`. Newton's method
  /// starts from v₀, as the seed does; the first linear solve starts from the last accepted step's acceleration, which
  /// more than halves its iterations and leaves its tolerance as it is (so the bits of a step depend on the step
  /// before). Accepted, it sets `state` and drags the contacts' friction anchors along; otherwise both stay untouched
  /// and the caller splits the time. It is accepted when an iterate's residual is below options.newton_tolerance. An
  /// iteration that can't lower the residual is divergence, unless the residual is already below the tolerance and
  /// below a hundredth of a step's weight (perfect rest can't be improved, and is not divergence). `trim_contacts`:
  /// those of the rigid trims, treated alike; null for none.
  StepOutcome step(State& state, double h, double stiffness_factor, std::vector<Contact>& contacts,
                   const Kinematic& kinematic, StepTimes& times, std::vector<TrimContact>* trim_contacts = nullptr);

  /// From the next step on the fabrics' damping is this share of their own (powers of two come back to the same bits).
  void set_damping(double factor);

  /// From the next step on weight is this share of the whole; 1 at first, or 0 without options.gravity. Forces and
  /// energies of a state at rest (static_forces, energies_by_term) have the whole weight all the same.
  void set_weight(double share);

  const std::vector<double>& masses() const;  ///< lumped, per vertex [kg]
  Energies energies(const State& state, const std::vector<Contact>& contacts) const;
  /// What each static term and gravity store at these positions; a new term of StaticSystem is in it by itself. Where
  /// there are elastics, drawcords or trims, `tension`, `attachment` and `trim_contact` follow, and gravity has the
  /// trims' share.
  std::vector<TermEnergy> energies_by_term(const Positions& x, const std::vector<RigidState>& trims = {},
                                           const std::vector<TrimContact>& trim_contacts = {}) const;
  std::vector<double> kinetic_energy(const State& state) const;  ///< per vertex, then per trim [J]
  /// Net force of all terms at rest, gravity and contacts (with friction) included, on every vertex, held ones too [N].
  /// Those of the trims follow, two each: the force on the centre [N], and the torque over RigidBody::gyration [N].
  Positions static_forces(const Positions& x, const std::vector<Contact>& contacts,
                          const std::vector<RigidState>& trims = {},
                          const std::vector<TrimContact>& trim_contacts = {}) const;
  /// Per vertex, the sum of the magnitudes of its shares of contact forces [N].
  std::vector<double> contact_forces(const Positions& x, const std::vector<Contact>& contacts,
                                     const std::vector<RigidState>& trims = {},
                                     const std::vector<TrimContact>& trim_contacts = {}) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace toile
