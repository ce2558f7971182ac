#pragma once
// Turns queued jobs into finished ones: each worker leases a job, lays its inputs into a folder, runs `toile drape` on
// it as a child process under watch, and publishes what came of it in one transaction that checks the lease.
//
// How a run ends, and what that makes of the job:
//   exit 0            succeeded, with its artifacts
//   exit 2            failed, with the problem that the run told (the input can't be simulated; never tried again)
//   exit 3            failed, code not_converged; report and mesh are kept for the diagnosis
//   wall-clock limit  failed, code run_too_long (the same run would take as long again)
//   anything else     tried again, kMaxAttempts times in all, then failed, code run_died
// A crash, an endless loop or a memory hog costs an attempt, never the server or a neighbour.

#include "server/queue/child_process.h"
#include "server/queue/clock.h"
#include "server/store/store.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace toile {

struct DispatcherOptions {
  std::string runner;          ///< executable that understands `drape SCENE --out DIR --progress-fd N --threads N`
  std::filesystem::path runs;  ///< parent of the runs' folders; emptied at start
  int workers = 1;             ///< runs at once
  int threads_per_run = 1;
  ChildLimits limits;
  std::chrono::milliseconds wall_limit{std::chrono::hours(1)};
  std::chrono::milliseconds heartbeat{1000};
  std::chrono::milliseconds lease{30'000};  ///< time without a heartbeat after which a run is taken for dead
  std::chrono::milliseconds grace{5000};    ///< between asking a run to end and killing it
  std::chrono::milliseconds poll{1000};     ///< between looks at the queue when nobody calls notify()
  std::chrono::milliseconds retry_delay{500};
};

/// Thread-safe.
class Dispatcher {
 public:
  /// Releases the leases of the process before, empties the runs' folder and starts the workers. `store` must outlive
  /// it.
  Dispatcher(Store& store, Clock clock, DispatcherOptions options);
  Dispatcher(const Dispatcher&) = delete;
  Dispatcher& operator=(const Dispatcher&) = delete;
  /// Stops: runs are asked to end, their jobs go back into the queue without losing an attempt.
  ~Dispatcher();

  /// Something changed in the store: a job was queued or asked to cancel.
  void notify();
  void stop();
  /// Whether each worker has shown a sign of life of late, and not only failures of the store.
  bool is_healthy() const;

 private:
  struct Worker;
  void work(Worker& worker);
  void run(Worker& worker, const Lease& lease);
  void idle();

  Store& store_;
  Clock clock_;
  DispatcherOptions options_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  long changes_ = 0;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace toile
