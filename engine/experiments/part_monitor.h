#pragma once
// Progress over several drapes in a row.

#include "engine/monitor.h"

namespace toile {

/// Passes a drape's progress on as the share [from, to] of a longer run.
class PartMonitor final : public Monitor {
 public:
  PartMonitor(Monitor& whole, double from, double to) : whole_(whole), from_(from), to_(to) {}
  bool report(const Progress& progress) override {
    Progress scaled = progress;
    scaled.fraction_done = from_ + (to_ - from_) * progress.fraction_done;
    return whole_.report(scaled);
  }

 private:
  Monitor& whole_;
  double from_, to_;
};

}  // namespace toile
