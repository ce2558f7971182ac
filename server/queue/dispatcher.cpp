#include "server/queue/dispatcher.h"

#include "server/queue/job_folder.h"
#include "server/queue/run_outcome.h"

#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace toile {
namespace {

using SteadyClock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// A worker without a sign of life for this long is stuck.
constexpr std::chrono::seconds kSignOfLife{15};

/// A run that says it went well but left no report did not go well.
void require_report(RunOutcome& outcome) {
  if (outcome.final_state != JobState::succeeded) return;
  const auto is_report = [](const Artifact& artifact) { return artifact.name == "report.json"; };
  if (std::any_of(outcome.artifacts.begin(), outcome.artifacts.end(), is_report)) return;
  outcome.final_state.reset();
  outcome.reason += " without a report";
}

}  // namespace

struct Dispatcher::Worker {
  Worker() : wake_fd(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (wake_fd < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { close(wake_fd); }
  void wake() const {
    const std::uint64_t one = 1;
    if (write(wake_fd, &one, sizeof one) < 0) return;  // full: it is awake already
  }
  void sign_of_life() { last_sign = SteadyClock::now(); }

  int wake_fd;
  std::atomic<SteadyClock::time_point> last_sign{SteadyClock::now()};
  std::thread thread;
};

Dispatcher::Dispatcher(Store& store, Clock clock, DispatcherOptions options)
    : store_(store), clock_(std::move(clock)), options_(std::move(options)) {
  fs::remove_all(options_.runs);
  fs::create_directories(options_.runs);
  fs::permissions(options_.runs, fs::perms::owner_all);
  options_.runner = fs::absolute(options_.runner).string();  // a child starts in its own folder
  const long released = store_.release_all_leases(clock_());
  if (released > 0) spdlog::warn("{} runs of the process before are void", released);
  for (int i = 0; i < options_.workers; ++i) workers_.push_back(std::make_unique<Worker>());
  for (const auto& worker : workers_) worker->thread = std::thread([this, &worker = *worker] { work(worker); });
}

Dispatcher::~Dispatcher() { stop(); }

void Dispatcher::notify() {
  {
    const std::lock_guard lock(mutex_);
    ++changes_;
  }
  changed_.notify_all();
  for (const auto& worker : workers_) worker->wake();
}

void Dispatcher::stop() {
  stopping_ = true;
  notify();
  for (const auto& worker : workers_) {
    if (worker->thread.joinable()) worker->thread.join();
  }
}

bool Dispatcher::is_healthy() const {
  const auto oldest = SteadyClock::now() - kSignOfLife;
  return std::all_of(workers_.begin(), workers_.end(),
                     [&](const auto& worker) { return worker->last_sign.load() > oldest; });
}

void Dispatcher::idle() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, options_.poll, [this, seen = changes_] { return stopping_ || changes_ != seen; });
}

void Dispatcher::work(Worker& worker) {
  while (!stopping_) {
    try {
      const std::optional<Lease> lease = store_.lease(clock_(), options_.lease.count());
      worker.sign_of_life();
      if (lease) {
        run(worker, *lease);
      } else {
        idle();
      }
    } catch (const std::exception& error) {
      // The lease, if there was one, runs out by itself; health tells when this does not pass.
      spdlog::error("worker: {}", error.what());
      idle();
    }
  }
}

void Dispatcher::run(Worker& worker, const Lease& lease) {
  spdlog::info("job {} attempt {} starts", lease.job_id, lease.attempt);
  RunOutcome outcome;
  LeaseState state = LeaseState::held;
  try {
    const JobFolder folder(options_.runs, lease.job_id);
    lay_inputs(folder, lease.scene, [this](const std::string& digest) { return store_.asset(digest); });

    RunLines lines;
    auto last_heartbeat = SteadyClock::now();
    ChildWatch watch;
    watch.period = options_.heartbeat;
    watch.wall_limit = options_.wall_limit;
    watch.grace = options_.grace;
    watch.wake_fd = worker.wake_fd;
    watch.on_line = [&](std::string_view line) { lines.add(line); };
    watch.keep_running = [&] {
      if (stopping_) return false;
      try {
        state = store_.heartbeat(lease, lines.progress, clock_(), options_.lease.count());
        last_heartbeat = SteadyClock::now();
        worker.sign_of_life();
      } catch (const std::exception& error) {
        spdlog::error("job {}: no heartbeat: {}", lease.job_id, error.what());
        if (SteadyClock::now() - last_heartbeat > options_.lease) state = LeaseState::lost;
      }
      return state == LeaseState::held;
    };
    const ChildEnd end =
        run_child({{options_.runner, "drape", "scene.json", "--out", "out", "--progress-fd",
                    std::to_string(kProgressFd), "--threads", std::to_string(options_.threads_per_run)},
                   folder.path().string(),
                   options_.limits},
                  watch);
    worker.sign_of_life();
    outcome = judge(end, lines);
    if (outcome.keeps_artifacts) outcome.artifacts = collect_artifacts(folder.out());
    require_report(outcome);
  } catch (const StoreError&) {
    throw;
  } catch (const std::exception& error) {
    outcome = {};
    outcome.reason = error.what();
  }

  const TimeMs now = clock_();
  if (state == LeaseState::lost) {
    spdlog::warn("job {} attempt {}: lease lost, its results are void", lease.job_id, lease.attempt);
    return;
  }
  bool done = false;
  if (outcome.stopped && state == LeaseState::cancel_requested) {
    done = store_.publish(lease, JobState::cancelled, "", {}, now);
  } else if (outcome.stopped) {
    done = store_.hand_back(lease, now);
  } else if (outcome.final_state) {
    done = store_.publish(lease, *outcome.final_state, outcome.problem, outcome.artifacts, now);
  } else {
    done = store_.give_up(lease, outcome.reason, now, now + lease.attempt * options_.retry_delay.count());
  }
  spdlog::info("job {} attempt {} ended: {}{}", lease.job_id, lease.attempt, outcome.reason,
               done ? "" : " (lease lost, results void)");
}

}  // namespace toile
