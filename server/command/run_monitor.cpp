#include "server/command/run_monitor.h"

#include "server/queue/run_outcome.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

namespace toile {
namespace {

constexpr std::chrono::milliseconds kBetweenLines{200};
constexpr int kBarWidth = 30;  // characters

// A signal handler can reach nothing but a global.
volatile sig_atomic_t stop_asked = 0;

void ask_to_stop(int number) {
  stop_asked = 1;
  signal(number, SIG_DFL);
}

[[noreturn]] void end_now() { _exit(static_cast<int>(RunExit::cancelled)); }

void write_line(int descriptor, std::string text) {
  text += '\n';
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t count = write(descriptor, rest.data(), rest.size());
    if (count > 0) {
      rest.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EPIPE) {
      end_now();
    } else if (errno != EINTR) {
      return;  // progress is a courtesy; its loss must not end a run
    }
  }
}

double finite(double value) { return std::isfinite(value) ? value : 0.0; }

}  // namespace

void catch_stop_signals() {
  signal(SIGINT, ask_to_stop);
  signal(SIGTERM, ask_to_stop);
  signal(SIGPIPE, SIG_IGN);
}

bool stop_was_asked() { return stop_asked != 0; }

void end_with_reader_of(int descriptor) {
  std::thread([descriptor] {
    pollfd reader{descriptor, 0, 0};  // POLLERR is told without being asked for: the pipe's other end is closed
    for (;;) {
      if (poll(&reader, 1, -1) < 0) continue;
      if ((reader.revents & POLLERR) != 0) end_now();
      if ((reader.revents & POLLNVAL) != 0) return;
    }
  }).detach();
}

RunMonitor::RunMonitor(int progress_fd) : progress_fd_(progress_fd), on_terminal_(isatty(STDERR_FILENO) == 1) {}

RunMonitor::~RunMonitor() { clear_bar(); }

bool RunMonitor::report(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_line_ >= kBetweenLines) {
    last_line_ = now;
    if (progress_fd_ >= 0) {
      nlohmann::json line;
      auto& document = line["progress"];
      document["stage"] = progress.stage;
      document["fraction"] = std::clamp(finite(progress.fraction_done), 0.0, 1.0);
      document["simulated_time_s"] = std::max(0.0, finite(progress.simulated_time_s));
      document["kinetic_energy_j"] = std::max(0.0, finite(progress.kinetic_energy_j));
      document["contacts"] = std::max(0L, progress.contacts);
      write_line(progress_fd_, line.dump());
    }
    if (on_terminal_) draw_bar(progress);
  }
  return !stop_was_asked();
}

void RunMonitor::tell_problem(const std::string& document) const {
  if (progress_fd_ >= 0) write_line(progress_fd_, "{\"problem\":" + document + "}");
}

void RunMonitor::draw_bar(const Progress& progress) {
  const double fraction = std::clamp(finite(progress.fraction_done), 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(std::lround(fraction * kBarWidth));
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  std::fprintf(stderr, "\r\033[K%-9.*s [%s] %3.0f %%  t = %.2f s  %ld contacts  %.1e J",
               static_cast<int>(progress.stage.size()), progress.stage.data(), bar.c_str(), 100 * fraction,
               progress.simulated_time_s, progress.contacts, progress.kinetic_energy_j);
  bar_is_drawn_ = true;
}

void RunMonitor::clear_bar() {
  if (bar_is_drawn_) std::fputs("\r\033[K", stderr);
  bar_is_drawn_ = false;
}

}  // namespace toile
