#pragma once
// What a run tells while it works, and how it is stopped: a bar on a terminal, JSON lines to a descriptor, SIGINT and
// SIGTERM, and the death of whoever reads the lines.

#include "engine/monitor.h"

#include <chrono>
#include <string>

namespace toile {

/// From now on SIGINT and SIGTERM ask the run to stop, once; a second one ends the process.
void catch_stop_signals();
bool stop_was_asked();

/// Ends the process (status 4) as soon as nobody reads `descriptor` any more: a run must not outlive its server. Starts
/// a thread that sleeps until then.
void end_with_reader_of(int descriptor);

class RunMonitor final : public Monitor {
 public:
  /// `progress_fd`: where the lines {"progress": {…}} go, -1 for nowhere.
  explicit RunMonitor(int progress_fd);
  ~RunMonitor() override;
  bool report(const Progress& progress) override;
  /// A line {"problem": …}; `document` is JSON on one line.
  void tell_problem(const std::string& document) const;
  /// Wipes the bar off the terminal.
  void clear_bar();

 private:
  void draw_bar(const Progress& progress);
  int progress_fd_;
  bool on_terminal_;
  bool bar_is_drawn_ = false;
  std::chrono::steady_clock::time_point last_line_{};
};

}  // namespace toile
