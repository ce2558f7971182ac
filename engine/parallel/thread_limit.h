#pragma once
// How many threads the engine may use.

#include <tbb/global_control.h>

#include <optional>

namespace toile {

/// While it lives, at most `threads` threads work in the whole process; 0 leaves oneTBB's default (all cores). Limits
/// nest; the smallest wins.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads) {
    if (threads > 0) control_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

 private:
  std::optional<tbb::global_control> control_;
};

}  // namespace toile
