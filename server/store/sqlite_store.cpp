#include "server/store/sqlite_store.h"

#include "server/store/sqlite_connection.h"
#include "server/store/sqlite_migrations.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <type_traits>

namespace toile {
namespace {

using namespace std::chrono_literals;

constexpr auto kCheckPatience = 1s;
// The columns of `read_job`, in its order.
#define TOILE_JOB_COLUMNS                                                                                         \
  "id, state, created_ms, started_ms, finished_ms, attempts, cancel_requested, progress, last_failure, problem, " \
  "seq "

/// Holds `directory`/lock for the life of the store.
class DirectoryLock {
 public:
  explicit DirectoryLock(const std::string& directory) {
    if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST) refuse("can't make " + directory);
    const std::string path = directory + "/lock";
    descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor_ < 0) refuse("can't open " + path);
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      close(descriptor_);
      refuse("another process holds " + directory);
    }
  }
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  ~DirectoryLock() { close(descriptor_); }

 private:
  [[noreturn]] static void refuse(const std::string& what) {
    throw StoreError(StoreError::Kind::unavailable, what + ": " + std::strerror(errno));
  }
  int descriptor_ = -1;
};

/// A connection and the lock that whoever uses it holds.
struct Guarded {
  Guarded(const std::string& path, SqliteConnection::Mode mode, const std::string& vfs) : connection(path, mode, vfs) {}
  std::timed_mutex mutex;
  SqliteConnection connection;
};

std::optional<TimeMs> optional_time(const SqliteStatement& row, int column) {
  return row.is_null(column) ? std::nullopt : std::optional<TimeMs>(row.integer(column));
}

JobRecord read_job(const SqliteStatement& row) {
  JobRecord job;
  job.id = row.bytes(0);
  job.state = job_state_named(row.bytes(1)).value();
  job.created = row.integer(2);
  job.started = optional_time(row, 3);
  job.finished = optional_time(row, 4);
  job.attempts = static_cast<int>(row.integer(5));
  job.cancel_requested = row.integer(6) != 0;
  job.progress = row.bytes(7);
  job.last_failure = row.bytes(8);
  job.problem = row.bytes(9);
  return job;
}

long place_in_queue(SqliteConnection& connection, std::int64_t seq) {
  SqliteStatement count = connection.prepare("SELECT count(*) FROM jobs WHERE state = 'queued' AND seq <= ?1");
  count.bind(1, seq).step();
  return count.integer(0);
}

JobRecord read_job_with_place(SqliteConnection& connection, const SqliteStatement& row) {
  JobRecord job = read_job(row);
  if (job.state == JobState::queued) job.place_in_queue = place_in_queue(connection, row.integer(10));
  return job;
}

std::optional<JobRecord> find_job(SqliteConnection& connection, const std::string& id) {
  SqliteStatement row = connection.prepare("SELECT " TOILE_JOB_COLUMNS "FROM jobs WHERE id = ?1");
  if (!row.bind(1, id).step()) return std::nullopt;
  return read_job_with_place(connection, row);
}

void finish(SqliteConnection& connection, const std::string& id, JobState state, const std::string& problem,
            TimeMs now) {
  connection
      .prepare("UPDATE jobs SET state = ?2, problem = ?3, finished_ms = ?4, lease_deadline_ms = NULL WHERE id = ?1")
      .bind(1, id)
      .bind(2, name_of(state))
      .bind(3, problem)
      .bind(4, now)
      .step();
}

/// What becomes of a job whose attempt came to nothing.
void end_attempt(SqliteConnection& connection, const JobRecord& job, const std::string& reason, TimeMs now,
                 TimeMs not_before) {
  if (job.cancel_requested) {
    finish(connection, job.id, JobState::cancelled, "", now);
  } else if (job.attempts >= kMaxAttempts) {
    finish(connection, job.id, JobState::failed,
           failure_document(
               500, "run_died",
               "The run died " + std::to_string(job.attempts) + " times, the last time because " + reason + "."),
           now);
  } else {
    connection
        .prepare(
            "UPDATE jobs SET state = 'queued', lease_deadline_ms = NULL, not_before_ms = ?2, last_failure = ?3, "
            "progress = '' WHERE id = ?1")
        .bind(1, job.id)
        .bind(2, not_before)
        .bind(3, reason)
        .step();
  }
}

/// Ends the attempts of all running jobs whose lease ran out before `deadline`.
long end_overdue_attempts(SqliteConnection& connection, TimeMs deadline, const std::string& reason, TimeMs now) {
  std::vector<JobRecord> overdue;
  {
    SqliteStatement row =
        connection.prepare("SELECT " TOILE_JOB_COLUMNS "FROM jobs WHERE state = 'running' AND lease_deadline_ms < ?1");
    row.bind(1, deadline);
    while (row.step()) overdue.push_back(read_job(row));
  }
  for (const JobRecord& job : overdue) end_attempt(connection, job, reason, now, now);
  return static_cast<long>(overdue.size());
}

/// The job if this lease is its newest and it is running.
std::optional<JobRecord> leased_job(SqliteConnection& connection, const Lease& lease) {
  SqliteStatement row = connection.prepare("SELECT " TOILE_JOB_COLUMNS
                                           "FROM jobs WHERE id = ?1 AND state = 'running' AND lease_token = ?2");
  if (!row.bind(1, lease.job_id).bind(2, lease.token).step()) return std::nullopt;
  return read_job(row);
}

void insert_artifact(SqliteConnection& connection, const std::string& job_id, const Artifact& artifact) {
  connection
      .prepare(
          "INSERT INTO artifacts (job_seq, name, media_type, sha256, bytes) "
          "SELECT seq, ?2, ?3, ?4, ?5 FROM jobs WHERE id = ?1 ON CONFLICT DO NOTHING")
      .bind(1, job_id)
      .bind(2, artifact.name)
      .bind(3, artifact.media_type)
      .bind(4, artifact.sha256)
      .bind_blob(5, artifact.bytes)
      .step();
}

class SqliteStore final : public Store {
 public:
  SqliteStore(const std::string& directory, const std::string& vfs)
      : lock_(directory), writer_(directory + "/toile.sqlite3", SqliteConnection::Mode::read_write_create, vfs) {
    writer_.connection.execute(
        "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA trusted_schema = OFF");
    migrate(writer_.connection);
    reader_.emplace(directory + "/toile.sqlite3", SqliteConnection::Mode::read_only, vfs);
  }

  bool put_asset(const std::string& sha256, std::string_view bytes, TimeMs now) override {
    return write([&](SqliteConnection& db) {
      db.prepare("INSERT INTO assets (sha256, created_ms, bytes) VALUES (?1, ?2, ?3) ON CONFLICT DO NOTHING")
          .bind(1, sha256)
          .bind(2, now)
          .bind_blob(3, bytes)
          .step();
      return db.changes() == 1;
    });
  }

  bool has_asset(const std::string& sha256) override {
    return read([&](SqliteConnection& db) {
      return db.prepare("SELECT 1 FROM assets WHERE sha256 = ?1").bind(1, sha256).step();
    });
  }

  std::optional<std::string> asset(const std::string& sha256) override {
    return read([&](SqliteConnection& db) -> std::optional<std::string> {
      SqliteStatement row = db.prepare("SELECT bytes FROM assets WHERE sha256 = ?1");
      if (!row.bind(1, sha256).step()) return std::nullopt;
      return row.bytes(0);
    });
  }

  Submission submit(const NewJob& job, TimeMs now) override {
    return write([&](SqliteConnection& db) {
      if (job.idempotency_key) {
        SqliteStatement row = db.prepare("SELECT id, fingerprint FROM jobs WHERE idempotency_key = ?1");
        if (row.bind(1, *job.idempotency_key).step()) {
          const auto kind = row.bytes(1) == job.fingerprint ? Submission::Kind::repeated : Submission::Kind::key_reused;
          return Submission{kind, find_job(db, row.bytes(0)).value()};
        }
      }
      SqliteStatement insert = db.prepare(
          "INSERT INTO jobs (id, state, created_ms, idempotency_key, fingerprint, scene) "
          "VALUES (?1, 'queued', ?2, ?3, ?4, ?5)");
      insert.bind(1, job.id).bind(2, now).bind(4, job.fingerprint).bind(5, job.scene);
      if (job.idempotency_key) {
        insert.bind(3, *job.idempotency_key);
      } else {
        insert.bind_null(3);
      }
      insert.step();
      return Submission{Submission::Kind::created, find_job(db, job.id).value()};
    });
  }

  std::optional<JobRecord> job(const std::string& id) override {
    return read([&](SqliteConnection& db) { return find_job(db, id); });
  }

  JobPage jobs(std::optional<JobState> state, const std::string& cursor, int limit) override {
    return read([&](SqliteConnection& db) {
      std::int64_t before = INT64_MAX;
      if (!cursor.empty()) {
        SqliteStatement row = db.prepare("SELECT seq FROM jobs WHERE id = ?1");
        if (!row.bind(1, cursor).step()) return JobPage{};
        before = row.integer(0);
      }
      SqliteStatement row =
          state ? db.prepare("SELECT " TOILE_JOB_COLUMNS
                             "FROM jobs WHERE seq < ?1 AND state = ?3 ORDER BY seq DESC LIMIT ?2")
                : db.prepare("SELECT " TOILE_JOB_COLUMNS "FROM jobs WHERE seq < ?1 ORDER BY seq DESC LIMIT ?2");
      row.bind(1, before).bind(2, std::int64_t{limit} + 1);
      if (state) row.bind(3, name_of(*state));
      JobPage page;
      while (row.step()) {
        if (static_cast<int>(page.jobs.size()) == limit) {
          page.next_cursor = page.jobs.back().id;
          break;
        }
        page.jobs.push_back(read_job_with_place(db, row));
      }
      return page;
    });
  }

  long queued_jobs() override {
    return read([](SqliteConnection& db) {
      return static_cast<long>(db.integer("SELECT count(*) FROM jobs WHERE state = 'queued'"));
    });
  }

  std::optional<Lease> lease(TimeMs now, TimeMs duration_ms) override {
    if (!anything_to_lease(now)) return std::nullopt;  // an idle server writes nothing
    return write([&](SqliteConnection& db) -> std::optional<Lease> {
      end_overdue_attempts(db, now, "its lease ran out", now);
      SqliteStatement row = db.prepare(
          "UPDATE jobs SET state = 'running', attempts = attempts + 1, lease_token = lease_token + 1, "
          "lease_deadline_ms = ?2, started_ms = ?1, progress = '' "
          "WHERE seq = (SELECT seq FROM jobs WHERE state = 'queued' AND not_before_ms <= ?1 ORDER BY seq LIMIT 1) "
          "RETURNING id, attempts, lease_token, scene");
      if (!row.bind(1, now).bind(2, now + duration_ms).step()) return std::nullopt;
      return Lease{row.bytes(0), row.bytes(3), static_cast<int>(row.integer(1)), row.integer(2)};
    });
  }

  LeaseState heartbeat(const Lease& lease, const std::string& progress, TimeMs now, TimeMs duration_ms) override {
    return write([&](SqliteConnection& db) {
      const std::optional<JobRecord> job = leased_job(db, lease);
      if (!job) return LeaseState::lost;
      db.prepare("UPDATE jobs SET lease_deadline_ms = ?2, progress = ?3 WHERE id = ?1")
          .bind(1, lease.job_id)
          .bind(2, now + duration_ms)
          .bind(3, progress.empty() ? job->progress : progress)
          .step();
      return job->cancel_requested ? LeaseState::cancel_requested : LeaseState::held;
    });
  }

  bool publish(const Lease& lease, JobState state, const std::string& problem, const std::vector<Artifact>& artifacts,
               TimeMs now) override {
    return write([&](SqliteConnection& db) {
      if (!leased_job(db, lease)) return false;
      for (const Artifact& artifact : artifacts) insert_artifact(db, lease.job_id, artifact);
      finish(db, lease.job_id, state, problem, now);
      return true;
    });
  }

  bool give_up(const Lease& lease, const std::string& reason, TimeMs now, TimeMs not_before) override {
    return write([&](SqliteConnection& db) {
      const std::optional<JobRecord> job = leased_job(db, lease);
      if (job) end_attempt(db, *job, reason, now, not_before);
      return job.has_value();
    });
  }

  bool hand_back(const Lease& lease, TimeMs now) override {
    return write([&](SqliteConnection& db) {
      const std::optional<JobRecord> job = leased_job(db, lease);
      if (!job) return false;
      if (job->cancel_requested) {
        finish(db, lease.job_id, JobState::cancelled, "", now);
      } else {
        db.prepare(
              "UPDATE jobs SET state = 'queued', lease_deadline_ms = NULL, attempts = attempts - 1, progress = '' "
              "WHERE id = ?1")
            .bind(1, lease.job_id)
            .step();
      }
      return true;
    });
  }

  long release_all_leases(TimeMs now) override {
    return write([&](SqliteConnection& db) { return end_overdue_attempts(db, INT64_MAX, "the server stopped", now); });
  }

  CancelOutcome cancel(const std::string& id, TimeMs now) override {
    return write([&](SqliteConnection& db) {
      const std::optional<JobRecord> job = find_job(db, id);
      if (!job) return CancelOutcome::unknown_job;
      if (is_final(job->state)) return CancelOutcome::already_final;
      db.prepare("UPDATE jobs SET cancel_requested = 1 WHERE id = ?1").bind(1, id).step();
      if (job->state == JobState::running) return CancelOutcome::requested;
      finish(db, id, JobState::cancelled, "", now);
      return CancelOutcome::cancelled;
    });
  }

  void add_artifact(const std::string& job_id, const Artifact& artifact) override {
    write([&](SqliteConnection& db) {
      insert_artifact(db, job_id, artifact);
      return true;
    });
  }

  std::optional<Artifact> artifact(const std::string& job_id, const std::string& name) override {
    return read([&](SqliteConnection& db) -> std::optional<Artifact> {
      SqliteStatement row = db.prepare(
          "SELECT media_type, sha256, bytes FROM artifacts WHERE job_seq = (SELECT seq FROM jobs WHERE id = ?1) "
          "AND name = ?2");
      if (!row.bind(1, job_id).bind(2, name).step()) return std::nullopt;
      return Artifact{name, row.bytes(0), row.bytes(1), row.bytes(2)};
    });
  }

  void check() override {
    for (Guarded* side : {&writer_, &*reader_}) {
      const std::unique_lock lock(side->mutex, kCheckPatience);
      if (!lock) throw StoreError(StoreError::Kind::unavailable, "the store has been busy for a second");
      side->connection.integer("SELECT count(*) FROM (SELECT 1 FROM jobs LIMIT 1)");
      if (side == &writer_) {
        const SqliteTransaction rolled_back(side->connection);
        side->connection.execute("UPDATE jobs SET attempts = attempts WHERE seq = (SELECT max(seq) FROM jobs)");
      }
    }
  }

  SqliteDurability durability() {
    const std::lock_guard lock(writer_.mutex);
    SqliteStatement mode = writer_.connection.prepare("PRAGMA journal_mode");
    mode.step();
    return {mode.bytes(0), static_cast<int>(writer_.connection.integer("PRAGMA synchronous"))};
  }

 private:
  bool anything_to_lease(TimeMs now) {
    return read([&](SqliteConnection& db) {
      return db
          .prepare(
              "SELECT 1 WHERE EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND not_before_ms <= ?1) "
              "OR EXISTS (SELECT 1 FROM jobs WHERE state = 'running' AND lease_deadline_ms < ?1)")
          .bind(1, now)
          .step();
    });
  }

  template <typename Body>
  std::invoke_result_t<Body, SqliteConnection&> write(const Body& body) {
    const std::lock_guard lock(writer_.mutex);
    SqliteTransaction transaction(writer_.connection);
    auto result = body(writer_.connection);
    transaction.commit();
    return result;
  }

  template <typename Body>
  std::invoke_result_t<Body, SqliteConnection&> read(const Body& body) {
    const std::lock_guard lock(reader_->mutex);
    return body(reader_->connection);
  }

  DirectoryLock lock_;
  Guarded writer_;
  std::optional<Guarded> reader_;  ///< after the writer: opened later, closed earlier
};

#undef TOILE_JOB_COLUMNS

}  // namespace

std::unique_ptr<Store> open_sqlite_store(const std::string& directory, const std::string& vfs) {
  return std::make_unique<SqliteStore>(directory, vfs);
}

SqliteDurability sqlite_durability(Store& store) { return dynamic_cast<SqliteStore&>(store).durability(); }

}  // namespace toile
