#pragma once
// Sums that have the same bits on any number of threads.

#include "engine/parallel/parallel_for.h"

#include <array>
#include <vector>

namespace toile {

/// Sums K quantities over [0, count): body(begin, end) returns the partial sums of a range. The ranges are
/// [0, grain), [grain, 2 grain), … whatever the number of threads, and their partial sums are added in index order.
template <int K, class Body>
std::array<double, K> deterministic_sums(int count, int grain, const Body& body) {
  std::array<double, K> total{};
  if (count <= 0) return total;
  const int chunks = (count + grain - 1) / grain;
  std::vector<std::array<double, K>> partial(chunks);
  parallel_for_each(chunks, 1, [&](int chunk) {
    const int begin = chunk * grain;
    partial[chunk] = body(begin, begin + grain < count ? begin + grain : count);
  });
  for (const auto& p : partial)
    for (int k = 0; k < K; ++k) total[k] += p[k];
  return total;
}

/// One quantity: body(begin, end) returns a double.
template <class Body>
double deterministic_sum(int count, int grain, const Body& body) {
  return deterministic_sums<1>(count, grain,
                               [&](int begin, int end) { return std::array<double, 1>{body(begin, end)}; })[0];
}

}  // namespace toile
