#pragma once
// The embedded store: one SQLite file, everything in it, results included.
//
// WAL with synchronous=FULL: in simulated power cuts NORMAL lost acknowledged commits and FULL none. One connection
// writes and checkpoints, behind a lock, always with BEGIN IMMEDIATE; a second, read-only one serves what HTTP asks
// for without waiting for a write's fsync. The version of SQLite in Debian 12 has the WAL-reset bug of two connections
// that checkpoint at once, so a lock file keeps a second process out, and child processes never open the file.

#include "server/store/store.h"

#include <memory>
#include <string>

namespace toile {

/// Opens or makes `directory`/toile.sqlite3. Throws StoreError when another process holds it, when it is of another
/// program or of a newer version, or can't be written. `vfs`: SQLite file-system layer, empty for the default one.
std::unique_ptr<Store> open_sqlite_store(const std::string& directory, const std::string& vfs = {});

/// What the writing connection really runs with, asked of the live connection.
struct SqliteDurability {
  std::string journal_mode;  ///< "wal"
  int synchronous = 0;       ///< 2 is FULL
};
/// `store` must be one that open_sqlite_store made.
SqliteDurability sqlite_durability(Store& store);

}  // namespace toile
