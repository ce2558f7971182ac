#pragma once
// One child process under watch: spawned (posix_spawn: the server has threads, so a bare fork is out) in its own
// session and folder, with resource limits, its lines read from a pipe, ended with all its descendants.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// What a run may take. Zero means: no limit of ours.
struct ChildLimits {
  std::uint64_t address_space_bytes = 0;
  std::uint64_t cpu_s = 0;
  std::uint64_t file_bytes = 0;
  int nice = 5;  ///< runs give way to the server
};

struct ChildCommand {
  std::vector<std::string> arguments;  ///< the first is the executable's path
  std::string directory;               ///< the child's working directory
  ChildLimits limits;
};

/// The child writes its lines (JSON, one object a line) to this descriptor. When the reader of it is gone, the server
/// is dead, and the child has to end by itself.
inline constexpr int kProgressFd = 3;

/// Its functions are called on the thread of run_child and must not throw.
struct ChildWatch {
  std::function<void(std::string_view line)> on_line;
  /// Called once a period and whenever `wake_fd` is readable; false: end the child.
  std::function<bool()> keep_running;
  std::chrono::milliseconds period{1000};
  std::chrono::milliseconds wall_limit{0};  ///< 0: none
  std::chrono::milliseconds grace{5000};    ///< between SIGTERM and SIGKILL
  int wake_fd = -1;                         ///< an eventfd, or -1
};

struct ChildEnd {
  enum class How { exited, signalled, timed_out, stopped };
  How how = How::exited;
  int code = 0;             ///< exit status or signal number
  std::string stderr_tail;  ///< last lines on the standard error stream, kStderrTail bytes at most
};

/// Runs the command to its end. Throws std::system_error when it can't be started.
ChildEnd run_child(const ChildCommand& command, const ChildWatch& watch);

/// For people and logs: "exit status 7", "signal 9 (Killed)", "the wall-clock limit".
std::string describe(const ChildEnd& end);

inline constexpr std::size_t kLineLimit = 1U << 20;    ///< bytes; a longer line is dropped
inline constexpr std::size_t kStderrTail = 16U << 10;  ///< bytes

}  // namespace toile
