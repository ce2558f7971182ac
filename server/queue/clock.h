#pragma once
// The clock as a value that is handed in, so that a test can turn it.

#include "server/store/store.h"

#include <chrono>
#include <functional>

namespace toile {

using Clock = std::function<TimeMs()>;

inline TimeMs system_time_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace toile
