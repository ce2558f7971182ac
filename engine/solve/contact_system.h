#pragma once
// The contacts of one step in the solver's node order: their forces and their share of the system matrix.

#include "engine/contact/contact.h"
#include "engine/linear/block_matrix.h"
#include "engine/linear/contact_matrix.h"

namespace toile {

/// Built once per step, since contacts are frozen in it; evaluated at every iterate. Deterministic.
class ContactSystem {
 public:
  /// `place` maps the contacts' nodes to the solver's. Keeps no reference to the contacts.
  void rebuild(const std::vector<Contact>& contacts, const std::vector<int>& place);

  /// Adds the contacts' forces at x [N].
  void add_forces(const Positions& x, double stiffness, Positions& force);
  /// The same, and sets the matrix share to scale · Hessian: contacts of one node go into `fixed`'s diagonal, the
  /// others into coupled().
  void add_forces_and_matrix(const Positions& x, double stiffness, double scale, Positions& force, BlockMatrix& fixed);
  ContactMatrix& coupled() { return coupled_; }

  double energy(const Positions& x, double stiffness) const;  ///< [J]
  /// Adds |weight| · |force| of every contact to its nodes [N].
  void add_force_magnitudes(const Positions& x, double stiffness, std::vector<double>& magnitude) const;
  const std::vector<Contact>& contacts() const { return contacts_; }

 private:
  void evaluate(const Positions& x, double stiffness, bool with_hessian);
  void scatter(Positions& force) const;

  std::vector<Contact> contacts_;
  std::vector<Vec3> force_;
  std::vector<Eigen::Matrix3f> hessian_;
  std::vector<int> coupling_;  ///< index in coupled_, or −1 for a contact of one node
  ContactMatrix coupled_;
  struct Share {
    int contact;
    double weight;
  };
  std::vector<int> row_start_;
  std::vector<Share> shares_;  ///< node by node, contacts rising
};

}  // namespace toile
