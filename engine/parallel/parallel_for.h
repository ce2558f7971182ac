#pragma once
// Loops over disjoint outputs on oneTBB.

#include "engine/parallel/fork_join.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace toile {

/// Calls body(begin, end) on ranges of about `grain` indices that cover [0, count), in any order and on any thread. The
/// result does not depend on the number of threads as long as an index writes only what belongs to it. Runs in the
/// calling thread when one range holds everything.
template <class Body>
void parallel_ranges(int count, int grain, const Body& body) {
  if (count <= 0) return;
  if (count <= grain) {
    body(0, count);
    return;
  }
  ForkJoin order;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, grain),
      [&](const tbb::blocked_range<int>& r) {
        order.begin_task();
        body(r.begin(), r.end());
        order.end_task();
      },
      tbb::simple_partitioner());
  order.join();
}

/// Calls body(index) for every index in [0, count); see parallel_ranges.
template <class Body>
void parallel_for_each(int count, int grain, const Body& body) {
  parallel_ranges(count, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

}  // namespace toile
