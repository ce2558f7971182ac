#pragma once
// A symmetric sparse matrix of 3×3 blocks whose topology never changes.

#include "engine/types.h"

#include <immintrin.h>

#include <span>

namespace toile {

/// A vector over the nodes in single precision, padded to four numbers a node so that a node is one SIMD register; the
/// fourth stays zero.
struct alignas(16) Float4 {
  float x = 0, y = 0, z = 0, w = 0;
};
using NodeVector = std::vector<Float4>;

/// Values are single precision, nine per block, column by column; both triangles are stored, so that a product needs no
/// scatter and rows are independent. Slot i < rows is the diagonal block (i, i); the slots of row i's off-diagonal
/// blocks are rows + row_start[i] … rows + row_start[i + 1] − 1 with rising columns. A stencil looks its slots up once;
/// adding is then one indexed sum. (The first seed's §6.1 and §6.2.)
class BlockMatrix {
 public:
  BlockMatrix() = default;
  /// The topology: each pair of nodes that stands in one stencil. `stencil_nodes` holds, per list, `width` nodes a
  /// stencil.
  struct Stencils {
    std::span<const int> nodes;
    int width;
  };
  BlockMatrix(int rows, std::span<const Stencils> stencils);

  int rows() const { return rows_; }
  /// Slot of a block of the topology. Throws std::out_of_range for another.
  int slot(int row, int column) const;

  void set_zero();
  float* values(int slot) { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  const float* values(int slot) const { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  /// Adds to one block. Calls on different slots may run at the same time.
  void add(int slot, const Eigen::Matrix3f& block);
  /// Adds rowsᵢᵀ rowsⱼ to the blocks slots[6 i + j] of six nodes.
  void add_products(const std::array<int, 36>& slots, const std::array<Eigen::Matrix3f, 6>& rows);

  /// y = A x for rows [begin, end).
  void multiply_rows(int begin, int end, const NodeVector& x, NodeVector& y) const;

 private:
  int rows_ = 0;
  std::vector<int> row_start_, columns_;
  std::vector<float> values_;  ///< with three numbers of padding: the last column is read as four
};

inline void BlockMatrix::add(int slot, const Eigen::Matrix3f& block) {
  float* to = values(slot);
  const float* from = block.data();
  _mm256_storeu_ps(to, _mm256_add_ps(_mm256_loadu_ps(to), _mm256_loadu_ps(from)));
  to[8] += from[8];
}

}  // namespace toile
