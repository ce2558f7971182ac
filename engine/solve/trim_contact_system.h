#pragma once
// The contacts of rigid trims of one step in the solver's node order: their forces and their share of the system
// matrix.

#include "engine/linear/rank_one_matrix.h"
#include "engine/solve/trim_system.h"
#include "engine/terms/trim_contact.h"

namespace toile {

/// Built once per step, since contacts are frozen in it; evaluated at every iterate. There are few, so they are summed
/// one after another. `trims` is the system that begin_step() has told where its trims are.
class TrimContactSystem {
 public:
  /// `place` maps the contacts' cloth nodes to the solver's, of which there are `unknowns` with those of trims. Keeps
  /// no reference to the contacts.
  void rebuild(const std::vector<TrimContact>& contacts, const std::vector<int>& place, const TrimSystem& trims,
               int unknowns);

  void add_forces(const TrimSystem& trims, const Positions& x, double stiffness, Positions& force) const;
  /// The same; what a contact couples is set in wide(), the load on its lever goes into `fixed`'s diagonal, both times
  /// `scale`.
  void add_forces_and_matrix(const TrimSystem& trims, const Positions& x, double stiffness, double scale,
                             Positions& force, BlockMatrix& fixed);
  /// Null without contacts.
  RankOneMatrix* wide() { return contacts_.empty() ? nullptr : &wide_; }

  double energy(const TrimSystem& trims, const Positions& x, double stiffness) const;  ///< [J]
  /// Adds weight · |force| of every contact to its cloth nodes [N].
  void add_force_magnitudes(const TrimSystem& trims, const Positions& x, double stiffness,
                            std::vector<double>& magnitude) const;
  /// As advance_anchors() of terms/contact.h, with the state after an accepted step. `contacts`: those of rebuild().
  void advance_anchors(const TrimSystem& trims, const Positions& x, double stiffness,
                       std::vector<TrimContact>& contacts) const;

 private:
  TrimContactState state(const TrimContact& c, const TrimSystem& trims, const Positions& x) const;
  template <class Visit>
  void for_each_node(const TrimContact& c, const TrimSystem& trims, const Visit& visit) const;

  std::vector<TrimContact> contacts_;
  RankOneMatrix wide_;
};

}  // namespace toile
