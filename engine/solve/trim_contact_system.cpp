#include "engine/solve/trim_contact_system.h"

#include <cmath>

namespace toile {

/// visit(place in the stencil, node).
template <class Visit>
void TrimContactSystem::for_each_node(const TrimContact& c, const TrimSystem& trims, const Visit& visit) const {
  for (int i = 0; i < c.contact.count; ++i) visit(i, c.contact.nodes[i]);
  visit(3, trims.center_node(c.trim));
  visit(4, trims.rotation_node(c.trim));
}

void TrimContactSystem::rebuild(const std::vector<TrimContact>& contacts, const std::vector<int>& place,
                                const TrimSystem& trims, int unknowns) {
  contacts_ = contacts;
  std::vector<std::vector<int>> terms;
  for (TrimContact& c : contacts_) {
    for (int i = 0; i < c.contact.count; ++i) c.contact.nodes[i] = place[c.contact.nodes[i]];
    std::vector<int> nodes;
    for_each_node(c, trims, [&](int, int node) { nodes.push_back(node); });
    terms.insert(terms.end(), 3, nodes);
  }
  wide_.rebuild(unknowns, terms);
}

TrimContactState TrimContactSystem::state(const TrimContact& c, const TrimSystem& trims, const Positions& x) const {
  StencilPoints<3> cloth;
  for (int i = 0; i < c.contact.count; ++i) cloth[i] = x[c.contact.nodes[i]];
  return trim_contact_state(c, cloth, x[trims.center_node(c.trim)], trims.orientation(c.trim, x),
                            trims.bodies()[c.trim].gyration());
}

void TrimContactSystem::add_forces(const TrimSystem& trims, const Positions& x, double stiffness,
                                   Positions& force) const {
  for (const TrimContact& c : contacts_) {
    const StencilVector<5> gradient = trim_contact_gradient(c, stiffness, state(c, trims, x));
    for_each_node(c, trims, [&](int i, int node) { force[node] -= gradient.segment<3>(3 * i); });
  }
}

void TrimContactSystem::add_forces_and_matrix(const TrimSystem& trims, const Positions& x, double stiffness,
                                              double scale, Positions& force, BlockMatrix& fixed) {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const TrimContact& c = contacts_[k];
    const TrimContactResponse r = trim_contact_response(c, stiffness, state(c, trims, x));
    for_each_node(c, trims, [&](int i, int node) { force[node] += r.force.segment<3>(3 * i); });
    for (int row = 0; row < 3; ++row) {
      std::vector<Eigen::Vector3f> parts;
      for_each_node(c, trims, [&](int i, int) {
        parts.push_back((std::sqrt(scale) * r.rows[row].segment<3>(3 * i)).cast<float>());
      });
      wide_.set(static_cast<int>(3 * k) + row, parts);
    }
    fixed.add(trims.rotation_node(c.trim), Eigen::Matrix3f((scale * r.rotation).cast<float>()));
  }
}

double TrimContactSystem::energy(const TrimSystem& trims, const Positions& x, double stiffness) const {
  double sum = 0;
  for (const TrimContact& c : contacts_) sum += trim_contact_energy(c, stiffness, state(c, trims, x));
  return sum;
}

void TrimContactSystem::add_force_magnitudes(const TrimSystem& trims, const Positions& x, double stiffness,
                                             std::vector<double>& magnitude) const {
  for (const TrimContact& c : contacts_) {
    const double size = contact_response(c.contact, stiffness, state(c, trims, x).point).force.norm();
    for (int i = 0; i < c.contact.count; ++i) magnitude[c.contact.nodes[i]] += c.contact.weights[i] * size;
  }
}

void TrimContactSystem::advance_anchors(const TrimSystem& trims, const Positions& x, double stiffness,
                                        std::vector<TrimContact>& contacts) const {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    // The law of terms/contact.h, which takes p from the nodes: one node at p.
    Contact at_point = contacts[k].contact;
    at_point.count = 1;
    at_point.nodes[0] = 0;
    at_point.weights[0] = 1;
    advance_anchor(at_point, stiffness, {state(contacts_[k], trims, x).point});
    contacts[k].contact.anchor = at_point.anchor;
  }
}

}  // namespace toile
