#include "engine/solve/contact_system.h"

#include "engine/parallel/reduce.h"
#include "engine/terms/contact.h"

#include <cmath>

namespace toile {

namespace {

constexpr int kContactsPerTask = 512;

}  // namespace

void ContactSystem::rebuild(const std::vector<Contact>& contacts, const std::vector<int>& place) {
  const int rows = static_cast<int>(place.size());
  contacts_ = contacts;
  coupling_.assign(contacts.size(), -1);
  force_.assign(contacts.size(), Vec3::Zero());
  hessian_.assign(contacts.size(), Eigen::Matrix3f::Zero());
  row_start_.assign(rows + 1, 0);
  std::vector<ContactMatrix::Coupling> couplings;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    Contact& c = contacts_[k];
    for (int i = 0; i < c.count; ++i) {
      c.nodes[i] = place[c.nodes[i]];
      ++row_start_[c.nodes[i] + 1];
    }
    if (c.count < 2) continue;
    coupling_[k] = static_cast<int>(couplings.size());
    ContactMatrix::Coupling& coupling = couplings.emplace_back();
    coupling.count = c.count;
    for (int i = 0; i < c.count; ++i) {
      coupling.nodes[i] = c.nodes[i];
      coupling.weights[i] = static_cast<float>(c.weights[i]);
    }
  }
  coupled_.rebuild(rows, std::move(couplings));
  for (int row = 0; row < rows; ++row) row_start_[row + 1] += row_start_[row];
  shares_.resize(row_start_[rows]);
  std::vector<int> next(row_start_.begin(), row_start_.end() - 1);
  for (int k = 0; k < static_cast<int>(contacts_.size()); ++k)
    for (int i = 0; i < contacts_[k].count; ++i) shares_[next[contacts_[k].nodes[i]]++] = {k, contacts_[k].weights[i]};
}

void ContactSystem::evaluate(const Positions& x, double stiffness, bool with_hessian) {
  parallel_for_each(static_cast<int>(contacts_.size()), kContactsPerTask, [&](int k) {
    const ContactResponse r = contact_response(contacts_[k], stiffness, contact_point(contacts_[k], x));
    force_[k] = r.force;
    if (with_hessian) hessian_[k] = r.hessian.cast<float>();
  });
}

void ContactSystem::scatter(Positions& force) const {
  parallel_for_each(static_cast<int>(force.size()), 1024, [&](int row) {
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s)
      force[row] += shares_[s].weight * force_[shares_[s].contact];
  });
}

void ContactSystem::add_forces(const Positions& x, double stiffness, Positions& force) {
  if (contacts_.empty()) return;
  evaluate(x, stiffness, false);
  scatter(force);
}

void ContactSystem::add_forces_and_matrix(const Positions& x, double stiffness, double scale, Positions& force,
                                          BlockMatrix& fixed) {
  if (contacts_.empty()) return;
  evaluate(x, stiffness, true);
  scatter(force);
  for (int k = 0; k < static_cast<int>(contacts_.size()); ++k)
    if (coupling_[k] >= 0) coupled_.set_block(coupling_[k], static_cast<float>(scale) * hessian_[k]);
  parallel_for_each(fixed.rows(), 1024, [&](int row) {
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s) {
      const Share& share = shares_[s];
      if (coupling_[share.contact] < 0)
        fixed.add(row, static_cast<float>(scale * share.weight * share.weight) * hessian_[share.contact]);
    }
  });
}

double ContactSystem::energy(const Positions& x, double stiffness) const {
  return deterministic_sum(static_cast<int>(contacts_.size()), kContactsPerTask, [&](int begin, int end) {
    double sum = 0;
    for (int k = begin; k < end; ++k) sum += contact_energy(contacts_[k], stiffness, contact_point(contacts_[k], x));
    return sum;
  });
}

void ContactSystem::add_force_magnitudes(const Positions& x, double stiffness, std::vector<double>& magnitude) const {
  for (const Contact& c : contacts_) {
    const double size = contact_response(c, stiffness, contact_point(c, x)).force.norm();
    for (int i = 0; i < c.count; ++i) magnitude[c.nodes[i]] += std::abs(c.weights[i]) * size;
  }
}

}  // namespace toile
