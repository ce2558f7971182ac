#include "engine/linear/rank_one_matrix.h"

#include "engine/parallel/parallel_for.h"

#include <algorithm>

namespace toile {

void RankOneMatrix::rebuild(int rows, const std::vector<std::vector<int>>& nodes) {
  term_start_.assign(1, 0);
  nodes_.clear();
  for (const std::vector<int>& term : nodes) {
    nodes_.insert(nodes_.end(), term.begin(), term.end());
    term_start_.push_back(static_cast<int>(nodes_.size()));
  }
  parts_.assign(nodes_.size(), Eigen::Vector3f::Zero());
  gathered_.assign(nodes.size(), 0.0);
  row_start_.assign(rows + 1, 0);
  for (int node : nodes_) ++row_start_[node + 1];
  for (int row = 0; row < rows; ++row) row_start_[row + 1] += row_start_[row];
  shares_.resize(nodes_.size());
  std::vector<int> next(row_start_.begin(), row_start_.end() - 1);
  for (int k = 0; k < size(); ++k)
    for (int e = term_start_[k]; e < term_start_[k + 1]; ++e) shares_[next[nodes_[e]]++] = {k, e};
}

void RankOneMatrix::set(int term, std::span<const Eigen::Vector3f> parts) {
  std::copy(parts.begin(), parts.end(), parts_.begin() + term_start_[term]);
}

Eigen::Matrix3f RankOneMatrix::diagonal(int row) const {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (int s = row_start_[row]; s < row_start_[row + 1]; ++s) {
    const Eigen::Vector3f& g = parts_[shares_[s].entry];
    sum += g * g.transpose();
  }
  return sum;
}

void RankOneMatrix::gather(const NodeVector& x) {
  parallel_for_each(size(), 16, [&](int k) {
    double sum = 0;
    for (int e = term_start_[k]; e < term_start_[k + 1]; ++e) {
      const Float4& p = x[nodes_[e]];
      const Eigen::Vector3f& g = parts_[e];
      sum += double(g.x()) * double(p.x) + double(g.y()) * double(p.y) + double(g.z()) * double(p.z);
    }
    gathered_[k] = sum;
  });
}

void RankOneMatrix::multiply_add_rows(int begin, int end, NodeVector& y) const {
  for (int row = begin; row < end; ++row) {
    if (row_start_[row] == row_start_[row + 1]) continue;
    Eigen::Map<Eigen::Vector3f> sum(&y[row].x);
    for (int s = row_start_[row]; s < row_start_[row + 1]; ++s)
      sum += static_cast<float>(gathered_[shares_[s].term]) * parts_[shares_[s].entry];
  }
}

}  // namespace toile
