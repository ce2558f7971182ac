#include "engine/linear/block_matrix.h"

#include "engine/parallel/parallel_for.h"

#include <algorithm>
#include <stdexcept>

namespace toile {

namespace {

/// sum + B x. Each column of B is read as four numbers; the fourth lane carries garbage that is never stored.
inline __m128 multiply_add(const float* block, const Float4& x, __m128 sum) {
  sum = _mm_fmadd_ps(_mm_loadu_ps(block), _mm_broadcast_ss(&x.x), sum);
  sum = _mm_fmadd_ps(_mm_loadu_ps(block + 3), _mm_broadcast_ss(&x.y), sum);
  return _mm_fmadd_ps(_mm_loadu_ps(block + 6), _mm_broadcast_ss(&x.z), sum);
}

}  // namespace

BlockMatrix::BlockMatrix(int rows, std::span<const Stencils> stencils) : rows_(rows) {
  std::vector<std::vector<int>> neighbours(rows);
  for (const Stencils& list : stencils)
    for (std::size_t s = 0; s + list.width <= list.nodes.size(); s += list.width)
      for (int i = 0; i < list.width; ++i)
        for (int j = 0; j < list.width; ++j)
          if (i != j) neighbours[list.nodes[s + i]].push_back(list.nodes[s + j]);
  row_start_.assign(1, 0);
  for (auto& row : neighbours) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    row_start_.push_back(static_cast<int>(columns_.size()));
  }
  values_.assign(9 * (static_cast<std::size_t>(rows) + columns_.size()) + 3, 0.0f);
}

int BlockMatrix::slot(int row, int column) const {
  if (row == column) return row;
  const auto begin = columns_.begin() + row_start_.at(row), end = columns_.begin() + row_start_.at(row + 1);
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column) throw std::out_of_range("block outside the matrix topology");
  return rows_ + static_cast<int>(found - columns_.begin());
}

void BlockMatrix::set_zero() {
  parallel_ranges(static_cast<int>(values_.size()), 1 << 17,
                  [&](int begin, int end) { std::fill(values_.begin() + begin, values_.begin() + end, 0.0f); });
}

void BlockMatrix::add_outer_products(const std::array<int, 16>& slots, const std::array<Eigen::Vector3f, 4>& rows) {
  // Column by column a block is (a b c | a b c | a b c) times (x x x | y y y | z z z): eight lanes and one number.
  __m256 left[4], right[4];
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3f& r = rows[i];
    left[i] = _mm256_setr_ps(r[0], r[1], r[2], r[0], r[1], r[2], r[0], r[1]);
    right[i] = _mm256_setr_ps(r[0], r[0], r[0], r[1], r[1], r[1], r[2], r[2]);
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      float* to = values(slots[4 * i + j]);
      _mm256_storeu_ps(to, _mm256_fmadd_ps(left[i], right[j], _mm256_loadu_ps(to)));
      to[8] += rows[i][2] * rows[j][2];
    }
}

void BlockMatrix::multiply_rows(int begin, int end, const NodeVector& x, NodeVector& y) const {
  const __m128 keep = _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1));
  for (int row = begin; row < end; ++row) {
    __m128 even = multiply_add(values(row), x[row], _mm_setzero_ps());
    __m128 odd = _mm_setzero_ps();
    const float* block = values(rows_ + row_start_[row]);
    int k = row_start_[row];
    // Two chains of sums, so that one multiplication need not wait for the last.
    for (; k + 1 < row_start_[row + 1]; k += 2, block += 18) {
      even = multiply_add(block, x[columns_[k]], even);
      odd = multiply_add(block + 9, x[columns_[k + 1]], odd);
    }
    if (k < row_start_[row + 1]) odd = multiply_add(block, x[columns_[k]], odd);
    _mm_store_ps(&y[row].x, _mm_and_ps(_mm_add_ps(even, odd), keep));
  }
}

}  // namespace toile
