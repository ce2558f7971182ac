#pragma once
// A part of the system that couples many nodes at once, kept factored.

#include "engine/linear/block_matrix.h"

namespace toile {

/// Σ g gᵀ over terms whose vectors g reach over any number of nodes (a cord whose tension is one number along its
/// whole length). A product costs one dot product and one sum a term, where the blocks would fill the matrix with the
/// square of the term's nodes. Exact: nothing is lumped. The same bits on any number of threads.
class RankOneMatrix {
 public:
  /// The topology: the nodes of each term; a node may occur once a term. The vectors are zero.
  void rebuild(int rows, const std::vector<std::vector<int>>& nodes);
  int size() const { return static_cast<int>(term_start_.size()) - 1; }
  /// Sets g of a term, one part a node in the order given to rebuild().
  void set(int term, std::span<const Eigen::Vector3f> parts);
  /// Σ gᵢ gᵢᵀ over the terms of a node: its diagonal block.
  Eigen::Matrix3f diagonal(int row) const;

  /// First half of a product, to be called before rows are multiplied: gᵀ x of every term.
  void gather(const NodeVector& x);
  /// Second half: adds Σ g (gᵀ x) to y's rows [begin, end).
  void multiply_add_rows(int begin, int end, NodeVector& y) const;

 private:
  struct Share {
    int term, entry;
  };
  std::vector<int> term_start_ = {0};  ///< into nodes_ and parts_
  std::vector<int> nodes_;
  std::vector<Eigen::Vector3f> parts_;
  std::vector<double> gathered_;
  std::vector<int> row_start_;
  std::vector<Share> shares_;  ///< row by row, terms rising
};

}  // namespace toile
