#include "server/store/sqlite_migrations.h"

#include <array>

namespace toile {
namespace {

constexpr std::int64_t kApplicationId = 0x546f696c;  // "Toil"

// Steps are only ever appended. Large columns stand last, so that reading a row's state does not walk its overflow
// pages.
constexpr std::array<const char*, 1> kSteps{
    R"sql(
CREATE TABLE assets (
  sha256 TEXT PRIMARY KEY,
  created_ms INTEGER NOT NULL,
  bytes BLOB NOT NULL
) STRICT;

CREATE TABLE jobs (
  seq INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  state TEXT NOT NULL CHECK (state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  not_before_ms INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
  lease_token INTEGER NOT NULL DEFAULT 0,
  lease_deadline_ms INTEGER,
  idempotency_key TEXT UNIQUE,
  fingerprint TEXT NOT NULL,
  progress TEXT NOT NULL DEFAULT '',
  last_failure TEXT NOT NULL DEFAULT '',
  problem TEXT NOT NULL DEFAULT '',
  scene TEXT NOT NULL
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, seq);

CREATE TABLE artifacts (
  job_seq INTEGER NOT NULL REFERENCES jobs (seq),
  name TEXT NOT NULL,
  media_type TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  bytes BLOB NOT NULL,
  PRIMARY KEY (job_seq, name)
) STRICT;
)sql"};

}  // namespace

void migrate(SqliteConnection& connection) {
  const std::int64_t application = connection.integer("PRAGMA application_id");
  std::int64_t version = connection.integer("PRAGMA user_version");
  const bool fresh = application == 0 && version == 0 && connection.integer("SELECT count(*) FROM sqlite_schema") == 0;
  if (application != kApplicationId && !fresh) {
    throw StoreError(StoreError::Kind::unavailable, "the database file belongs to another program");
  }
  if (version > static_cast<std::int64_t>(kSteps.size())) {
    throw StoreError(StoreError::Kind::unavailable, "the database file was written by a newer version of toile");
  }
  for (; version < static_cast<std::int64_t>(kSteps.size()); ++version) {
    SqliteTransaction transaction(connection);
    connection.execute(kSteps[static_cast<std::size_t>(version)]);
    connection.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
    connection.execute("PRAGMA user_version = " + std::to_string(version + 1));
    transaction.commit();
  }
}

}  // namespace toile
