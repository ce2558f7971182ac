#pragma once
// The dynamic part of the system: what contacts couple.

#include "engine/linear/block_matrix.h"

namespace toile {

/// A sum over contacts of (w wᵀ) ⊗ H with up to four weights and one symmetric 3×3 block each. It is kept factored: a
/// product costs one 3×3 product per contact and one weighted sum per node, where the twelve off-diagonal blocks of a
/// contact of four nodes would cost 4 times the memory. (The first seed's §6.1 keeps off-diagonal blocks only and puts
/// diagonal ones into the static matrix; here that is done for contacts of one node, which have nothing else.)
class ContactMatrix {
 public:
  struct Coupling {
    std::array<int, 4> nodes{};
    std::array<float, 4> weights{};
    int count = 0;
  };

  /// The topology of one step; the blocks are zero.
  void rebuild(int rows, std::vector<Coupling> couplings);
  int size() const { return static_cast<int>(couplings_.size()); }
  /// Calls on different couplings may run at the same time.
  void set_block(int coupling, const Eigen::Matrix3f& h) { blocks_[coupling] = h; }
  /// Σ w² H over the couplings of a node: its diagonal block.
  Eigen::Matrix3f diagonal(int row) const;

  /// First half of a product, to be called for all couplings before rows are multiplied: q = H Σ w x.
  void gather(int begin, int end, const NodeVector& x);
  /// Second half: adds Σ w q to y's rows [begin, end).
  void multiply_add_rows(int begin, int end, NodeVector& y) const;

 private:
  struct Share {
    int coupling;
    float weight;
  };
  std::vector<Coupling> couplings_;
  std::vector<Eigen::Matrix3f> blocks_;
  std::vector<Eigen::Vector3f> gathered_;
  std::vector<int> row_start_;
  std::vector<Share> shares_;  ///< row by row, couplings rising
};

}  // namespace toile
