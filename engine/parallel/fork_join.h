#pragma once
// The order in which a parallel loop runs, told to ThreadSanitizer: oneTBB's library is not compiled for it, so that it
// sees none of the hand-overs between threads. Without that sanitizer all of this is empty.

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace toile {

/// One loop: what came before it happens before each of its tasks, and each task before what comes after `join`. Tasks
/// have no order among themselves, so that a race between two of them is found.
class ForkJoin {
 public:
#ifdef __SANITIZE_THREAD__
  ForkJoin() { __tsan_release(&fork_); }
  void begin_task() { __tsan_acquire(&fork_); }
  void end_task() { __tsan_release(&join_); }
  void join() { __tsan_acquire(&join_); }

 private:
  char fork_ = 0, join_ = 0;
#else
  void begin_task() {}
  void end_task() {}
  void join() {}
#endif
};

}  // namespace toile
