#pragma once
// The database's layout as a list of steps; PRAGMA user_version counts how many were taken.

#include "server/store/sqlite_connection.h"

namespace toile {

/// Brings the database to the newest layout, each step in its own transaction. Throws StoreError for a file that a
/// newer version of the program wrote, or that is some other program's.
void migrate(SqliteConnection& connection);

}  // namespace toile
