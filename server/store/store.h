#pragma once
// What the service remembers: assets, jobs, and the artifacts of finished jobs. The seam between the queue and a
// database; tests/server/store/store_contract.h is the one suite that every implementation has to pass.
//
// Time is a parameter of every call that needs it (milliseconds since the Unix epoch), so that a test back-dates a
// lease instead of sleeping. Every method may be called from any thread. A method that returns has made its change
// durable: it survives a power loss. A method that can't do so throws StoreError and has changed nothing.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// Milliseconds since the Unix epoch.
using TimeMs = std::int64_t;

enum class JobState { queued, running, succeeded, failed, cancelled };

std::string_view name_of(JobState state);
std::optional<JobState> job_state_named(std::string_view name);
inline bool is_final(JobState state) { return state != JobState::queued && state != JobState::running; }

class StoreError : public std::runtime_error {
 public:
  /// `full` is a disk or quota at its end (the caller can say so), `unavailable` all the rest.
  enum class Kind { full, unavailable };
  StoreError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// What is asked for. `fingerprint` tells two bodies under one idempotency key apart.
struct NewJob {
  std::string id;           ///< from make_job_id()
  std::string scene;        ///< the scene document, JSON, as checked
  std::string fingerprint;  ///< SHA-256 of the request's body, hexadecimal
  std::optional<std::string> idempotency_key;
};

struct JobRecord {
  std::string id;
  JobState state = JobState::queued;
  TimeMs created = 0;
  std::optional<TimeMs> started, finished;  ///< start of the latest attempt; end of the job
  int attempts = 0;                         ///< begun so far
  bool cancel_requested = false;
  long place_in_queue = 0;   ///< 1 is next; 0 when not queued
  std::string progress;      ///< last progress line of the run, JSON; empty before the first
  std::string last_failure;  ///< why the last attempt was not the last one; empty when there was none
  std::string problem;       ///< problem document of a failed job, JSON; empty otherwise
};

/// One attempt at one job. `token` fences: it grows with each lease of the job, and only the newest may change it.
struct Lease {
  std::string job_id;
  std::string scene;
  int attempt = 0;  ///< 1 is the first
  std::int64_t token = 0;
};

enum class LeaseState { held, cancel_requested, lost };

struct Artifact {
  std::string name;        ///< "report.json", "mesh.obj", "preview-front.png", …
  std::string media_type;  ///< "model/obj", …
  std::string sha256;      ///< of bytes, hexadecimal: the ETag
  std::string bytes;
};

struct Submission {
  enum class Kind { created, repeated, key_reused };
  Kind kind = Kind::created;
  JobRecord job;  ///< for repeated and key_reused the job that holds the key
};

struct JobPage {
  std::vector<JobRecord> jobs;  ///< newest first
  std::string next_cursor;      ///< empty on the last page
};

enum class CancelOutcome { unknown_job, cancelled, requested, already_final };

class Store {
 public:
  virtual ~Store() = default;

  /// Stores bytes under their digest; true when they were not there yet.
  virtual bool put_asset(const std::string& sha256, std::string_view bytes, TimeMs now) = 0;
  virtual bool has_asset(const std::string& sha256) = 0;
  virtual std::optional<std::string> asset(const std::string& sha256) = 0;

  /// Queues a job. With an idempotency key that is known: `repeated` when the fingerprint is the same, else
  /// `key_reused`.
  virtual Submission submit(const NewJob& job, TimeMs now) = 0;
  virtual std::optional<JobRecord> job(const std::string& id) = 0;
  /// At most `limit` jobs, newest first, in `state` if given, older than `cursor` (the id of the last job of the page
  /// before) if not empty. An unknown cursor gives an empty page.
  virtual JobPage jobs(std::optional<JobState> state, const std::string& cursor, int limit) = 0;
  virtual long queued_jobs() = 0;

  /// Takes the oldest queued job that may start by now, for `duration_ms`. First brings back running jobs whose lease
  /// has run out (each costs its attempt; the last attempt fails the job, a job asked to cancel becomes cancelled).
  virtual std::optional<Lease> lease(TimeMs now, TimeMs duration_ms) = 0;
  /// Prolongs the lease and records progress (kept as it was when empty).
  virtual LeaseState heartbeat(const Lease& lease, const std::string& progress, TimeMs now, TimeMs duration_ms) = 0;
  /// Ends the job with `state` (final) and its artifacts, all or nothing. False, and nothing changed, when the token is
  /// not the newest or the job is not running: then this attempt's results are void.
  virtual bool publish(const Lease& lease, JobState state, const std::string& problem,
                       const std::vector<Artifact>& artifacts, TimeMs now) = 0;
  /// Gives the attempt up: queued again, not before `not_before`; at max_attempts failed, with `reason` in its problem;
  /// cancelled when that was asked for. False when the lease is lost.
  virtual bool give_up(const Lease& lease, const std::string& reason, TimeMs now, TimeMs not_before) = 0;
  /// Gives the lease back as if it had not been taken (an orderly shutdown): the attempt does not count.
  virtual bool hand_back(const Lease& lease, TimeMs now) = 0;
  /// To be called once, by a process that knows that no other one works on this store: every lease is void, each
  /// running job is treated as one whose lease has run out. Returns how many there were.
  virtual long release_all_leases(TimeMs now) = 0;

  virtual CancelOutcome cancel(const std::string& id, TimeMs now) = 0;

  /// Adds an artifact to a finished job (a picture drawn on request); one that is there already stays as it is.
  virtual void add_artifact(const std::string& job_id, const Artifact& artifact) = 0;
  virtual std::optional<Artifact> artifact(const std::string& job_id, const std::string& name) = 0;

  /// Reads, and begins a write without making one; throws StoreError when either does not work within a second.
  virtual void check() = 0;
};

/// Attempts at one job, at most.
inline constexpr int kMaxAttempts = 3;

/// The problem document (schemas/problem.schema.json) of a job that failed outside the engine, as JSON text.
std::string failure_document(int status, std::string_view code, std::string_view detail);

}  // namespace toile
