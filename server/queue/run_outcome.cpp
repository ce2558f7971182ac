#include "server/queue/run_outcome.h"

#include "schemas/parse_json.h"

#include <nlohmann/json.hpp>

namespace toile {
namespace {

/// The end of what the run wrote to its error stream, for the reason of a death.
std::string last_words(const std::string& stderr_tail) {
  constexpr std::size_t kMost = 300;
  std::string text = stderr_tail.substr(stderr_tail.size() - std::min(stderr_tail.size(), kMost));
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.empty() ? text : "; its last words: " + text;
}

}  // namespace

void RunLines::add(std::string_view line) {
  try {
    const nlohmann::json document = parse_json(line);
    if (!document.is_object()) return;
    if (const auto member = document.find("progress"); member != document.end() && member->is_object()) {
      progress = member->dump();
    }
    if (const auto member = document.find("problem"); member != document.end() && member->is_object()) {
      problem = member->dump();
    }
  } catch (const std::exception&) {
    // A line that is torn or foreign says nothing; the exit status decides.
  }
}

RunOutcome judge(const ChildEnd& end, const RunLines& lines) {
  RunOutcome outcome;
  outcome.reason = describe(end);
  if (end.how == ChildEnd::How::stopped) {
    outcome.stopped = true;
    return outcome;
  }
  if (end.how == ChildEnd::How::timed_out) {
    outcome.final_state = JobState::failed;
    outcome.problem = failure_document(422, "run_too_long", "The run passed the wall-clock limit of this server.");
    return outcome;
  }
  if (end.how == ChildEnd::How::exited) {
    switch (static_cast<RunExit>(end.code)) {
      case RunExit::done:
        outcome.final_state = JobState::succeeded;
        outcome.keeps_artifacts = true;
        return outcome;
      case RunExit::bad_input:
        outcome.final_state = JobState::failed;
        outcome.problem =
            !lines.problem.empty()
                ? lines.problem
                : failure_document(422, "bad_input", "The input can't be simulated" + last_words(end.stderr_tail));
        return outcome;
      case RunExit::not_converged:
        outcome.final_state = JobState::failed;
        outcome.keeps_artifacts = true;
        outcome.problem = !lines.problem.empty()
                              ? lines.problem
                              : failure_document(422, "not_converged",
                                                 "The drape did not come to rest; the report tells what it is worth.");
        return outcome;
      case RunExit::cancelled:  // by someone else than the dispatcher
        break;
    }
  }
  outcome.reason += last_words(end.stderr_tail);
  return outcome;
}

}  // namespace toile
