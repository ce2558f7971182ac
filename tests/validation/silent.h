#pragma once
// A monitor for tests that only want the result.

#include "engine/monitor.h"

namespace toile::test {

struct Silent final : Monitor {
  bool report(const Progress&) override { return true; }
};

}  // namespace toile::test
