#include "engine/linear/contact_matrix.h"

#include <utility>

namespace toile {

void ContactMatrix::rebuild(int rows, std::vector<Coupling> couplings) {
  couplings_ = std::move(couplings);
  blocks_.assign(couplings_.size(), Eigen::Matrix3f::Zero());
  gathered_.assign(couplings_.size(), Eigen::Vector3f::Zero());
  row_start_.assign(rows + 1, 0);
  for (const Coupling& c : couplings_)
    for (int i = 0; i < c.count; ++i) ++row_start_[c.nodes[i] + 1];
  for (int row = 0; row < rows; ++row) row_start_[row + 1] += row_start_[row];
  shares_.resize(row_start_[rows]);
  std::vector<int> next(row_start_.begin(), row_start_.end() - 1);
  for (int k = 0; k < size(); ++k)
    for (int i = 0; i < couplings_[k].count; ++i)
      shares_[next[couplings_[k].nodes[i]]++] = {k, couplings_[k].weights[i]};
}

Eigen::Matrix3f ContactMatrix::diagonal(int row) const {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (int s = row_start_[row]; s < row_start_[row + 1]; ++s)
    sum += shares_[s].weight * shares_[s].weight * blocks_[shares_[s].coupling];
  return sum;
}

void ContactMatrix::gather(int begin, int end, const NodeVector& x) {
  for (int k = begin; k < end; ++k) {
    const Coupling& c = couplings_[k];
    Eigen::Vector3f p = Eigen::Vector3f::Zero();
    for (int i = 0; i < c.count; ++i) p += c.weights[i] * Eigen::Map<const Eigen::Vector3f>(&x[c.nodes[i]].x);
    gathered_[k] = blocks_[k] * p;
  }
}

void ContactMatrix::multiply_add_rows(int begin, int end, NodeVector& y) const {
  for (int row = begin; row < end; ++row) {
    Eigen::Map<Eigen::Vector3f> sum(&y[row].x);
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s)
      sum += shares_[s].weight * gathered_[shares_[s].coupling];
  }
}

}  // namespace toile
