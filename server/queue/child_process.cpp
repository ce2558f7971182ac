#include "server/queue/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

extern char** environ;

namespace toile {
namespace {

using SteadyClock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* what, int error) { throw std::system_error(error, std::generic_category(), what); }

class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() { reset(); }
  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }
  int get() const { return value_; }

 private:
  int value_;
};

struct Pipe {
  Descriptor read_end, write_end;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe2", errno);
  Pipe pipe{Descriptor(ends[0]), Descriptor(ends[1])};
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return pipe;
}

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

void limit(pid_t child, __rlimit_resource resource, std::uint64_t value) {
  if (value == 0) return;
  const rlimit both{value, value};
  prlimit(child, resource, &both, nullptr);
}

pid_t spawn(const ChildCommand& command, const Pipe& progress, const Pipe& errors) {
  // The three standard streams are always open in the server, so both pipe ends lie above kProgressFd or on it: the
  // order of the two dup2 matters only if the errors' end were kProgressFd, so it goes first.
  SpawnActions actions;
  posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(actions.get(), STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), errors.write_end.get(), STDERR_FILENO);
  posix_spawn_file_actions_adddup2(actions.get(), progress.write_end.get(), kProgressFd);
  posix_spawn_file_actions_addclosefrom_np(actions.get(), kProgressFd + 1);
  posix_spawn_file_actions_addchdir_np(actions.get(), command.directory.c_str());

  std::vector<char*> arguments;
  for (const std::string& argument : command.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const SpawnAttributes attributes;
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], actions.get(), attributes.get(), arguments.data(), environ);
  if (error != 0) fail(("can't start " + command.arguments[0]).c_str(), error);

  limit(child, RLIMIT_AS, command.limits.address_space_bytes);
  limit(child, RLIMIT_CPU, command.limits.cpu_s);
  limit(child, RLIMIT_FSIZE, command.limits.file_bytes);
  const rlimit no_core{0, 0};
  prlimit(child, RLIMIT_CORE, &no_core, nullptr);
  setpriority(PRIO_PROCESS, static_cast<id_t>(child), command.limits.nice);
  return child;
}

/// Whether the child has ended; leaves it unreaped.
bool has_ended(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
}

/// Reads all there is; false at the end of the stream.
bool drain(int descriptor, const std::function<void(std::string_view)>& sink) {
  std::array<char, 1U << 14> buffer;
  for (;;) {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count > 0) {
      sink({buffer.data(), static_cast<std::size_t>(count)});
    } else if (count == 0) {
      return false;
    } else if (errno != EINTR) {
      return errno == EAGAIN;
    }
  }
}

/// Cuts a stream into lines; a line beyond kLineLimit is dropped whole.
class LineCutter {
 public:
  void add(std::string_view bytes, const std::function<void(std::string_view)>& on_line) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      const std::string_view piece = bytes.substr(0, end);
      if (line_.size() + piece.size() > kLineLimit) too_long_ = true;
      if (!too_long_) line_ += piece;
      if (end == std::string_view::npos) return;
      if (!too_long_ && !line_.empty() && on_line) on_line(line_);
      line_.clear();
      too_long_ = false;
      bytes.remove_prefix(end + 1);
    }
  }

 private:
  std::string line_;
  bool too_long_ = false;
};

}  // namespace

ChildEnd run_child(const ChildCommand& command, const ChildWatch& watch) {
  Pipe progress = make_pipe(), errors = make_pipe();
  const pid_t child = spawn(command, progress, errors);
  progress.write_end.reset();
  errors.write_end.reset();
  const Descriptor exit_notice(static_cast<int>(syscall(SYS_pidfd_open, child, 0)));

  // A kernel without pidfd_open (before 5.3, some sandboxes) tells of the end only when asked.
  const std::int64_t longest_wait = exit_notice.get() >= 0 ? 60'000 : 50;

  const auto started = SteadyClock::now();
  auto next_tick = started + watch.period;
  auto kill_at = SteadyClock::time_point::max();
  std::optional<ChildEnd::How> ended_by_us;
  const auto end_by_us = [&](ChildEnd::How how) {
    if (ended_by_us) return;
    ended_by_us = how;
    kill_at = SteadyClock::now() + watch.grace;
    kill(-child, SIGTERM);
  };

  ChildEnd end;
  LineCutter lines;
  const auto on_progress = [&](std::string_view bytes) { lines.add(bytes, watch.on_line); };
  const auto on_errors = [&](std::string_view bytes) {
    end.stderr_tail += bytes;
    if (end.stderr_tail.size() > 2 * kStderrTail) end.stderr_tail.erase(0, end.stderr_tail.size() - kStderrTail);
  };

  for (bool running = true; running;) {
    auto until = next_tick;
    if (watch.wall_limit.count() > 0 && !ended_by_us) until = std::min(until, started + watch.wall_limit);
    until = std::min(until, kill_at);
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(until - SteadyClock::now()).count();
    std::array<pollfd, 4> ready{pollfd{exit_notice.get(), POLLIN, 0}, pollfd{progress.read_end.get(), POLLIN, 0},
                                pollfd{errors.read_end.get(), POLLIN, 0}, pollfd{watch.wake_fd, POLLIN, 0}};
    poll(ready.data(), ready.size(), static_cast<int>(std::clamp<std::int64_t>(wait, 0, longest_wait)));

    running = !has_ended(child);
    if (!drain(progress.read_end.get(), on_progress)) progress.read_end.reset();
    if (!drain(errors.read_end.get(), on_errors)) errors.read_end.reset();
    bool tick = false;
    if ((ready[3].revents & POLLIN) != 0) {
      std::uint64_t count = 0;
      tick = read(watch.wake_fd, &count, sizeof count) > 0;
    }
    const auto now = SteadyClock::now();
    if (now >= next_tick) {
      tick = true;
      next_tick = now + watch.period;
    }
    if (running && tick && watch.keep_running && !watch.keep_running()) end_by_us(ChildEnd::How::stopped);
    if (watch.wall_limit.count() > 0 && now >= started + watch.wall_limit) end_by_us(ChildEnd::How::timed_out);
    if (now >= kill_at) {
      kill(-child, SIGKILL);
      kill_at = SteadyClock::time_point::max();
    }
  }

  // The child is dead but not yet reaped, so its process group's number still is its own: whatever it left behind goes.
  kill(-child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  end.how = ended_by_us.value_or(WIFSIGNALED(status) ? ChildEnd::How::signalled : ChildEnd::How::exited);
  end.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  if (end.stderr_tail.size() > kStderrTail) end.stderr_tail.erase(0, end.stderr_tail.size() - kStderrTail);
  return end;
}

std::string describe(const ChildEnd& end) {
  switch (end.how) {
    case ChildEnd::How::timed_out:
      return "it passed its wall-clock limit";
    case ChildEnd::How::stopped:
      return "it was stopped";
    case ChildEnd::How::signalled:
      return "it was ended by signal " + std::to_string(end.code) + " (" + strsignal(end.code) + ")";
    case ChildEnd::How::exited:
      break;
  }
  return "it ended with exit status " + std::to_string(end.code);
}

}  // namespace toile
