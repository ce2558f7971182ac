#pragma once
// What a run's end says about its job, and what its lines told. The run's side of this is server/command/.

#include "server/queue/child_process.h"
#include "server/store/store.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// Exit statuses of `toile drape`.
enum class RunExit : int { done = 0, bad_input = 2, not_converged = 3, cancelled = 4 };

/// The lines that a run writes to its progress descriptor: {"progress": {…}} many times, {"problem": {…}} at most once.
struct RunLines {
  std::string progress;  ///< JSON of the last progress; empty before the first
  std::string problem;   ///< JSON of the problem document; empty when none came
  /// Takes a line in; one that is neither is passed over.
  void add(std::string_view line);
};

struct RunOutcome {
  bool stopped = false;                 ///< ended because the dispatcher wanted it so
  std::optional<JobState> final_state;  ///< none: try again
  bool keeps_artifacts = false;
  std::string problem;  ///< problem document, JSON, for a failed job
  std::string reason;   ///< one clause for logs, and for a failure that is tried again
  std::vector<Artifact> artifacts;
};

RunOutcome judge(const ChildEnd& end, const RunLines& lines);

}  // namespace toile
