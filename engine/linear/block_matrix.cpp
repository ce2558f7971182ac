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

void BlockMatrix::add_products(const std::array<int, 36>& slots, const std::array<Eigen::Matrix3f, 6>& rows) {
  // Of each row, column by column, a block is (a b c | a b c | a b c) times (x x x | y y y | z z z): eight lanes and
  // one number.
  __m256 left[6][3], right[6][3];
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 3; ++k) {
      const float a = rows[i](k, 0), b = rows[i](k, 1), c = rows[i](k, 2);
      left[i][k] = _mm256_setr_ps(a, b, c, a, b, c, a, b);
      right[i][k] = _mm256_setr_ps(a, a, a, b, b, b, c, c);
    }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      float* to = values(slots[6 * i + j]);
      __m256 sum = _mm256_loadu_ps(to);
      for (int k = 0; k < 3; ++k) sum = _mm256_fmadd_ps(left[i][k], right[j][k], sum);
      _mm256_storeu_ps(to, sum);
      to[8] += rows[i].col(2).dot(rows[j].col(2));
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
