#pragma once
// SQLite's C interface with owners, and its error codes as StoreError. Nothing here knows what is stored.

#include "server/store/store.h"

#include <sqlite3.h>

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace toile {

class SqliteConnection;

/// A prepared statement borrowed from its connection, reset when it goes out of scope. Columns and parameters count
/// from 0 and 1, as in SQLite. Bound text and blobs must outlive the statement's use.
class SqliteStatement {
 public:
  explicit SqliteStatement(sqlite3_stmt* statement) : statement_(statement) {}
  SqliteStatement(SqliteStatement&& other) noexcept : statement_(std::exchange(other.statement_, nullptr)) {}
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;
  ~SqliteStatement();

  SqliteStatement& bind(int parameter, std::int64_t value);
  SqliteStatement& bind(int parameter, std::string_view text);
  SqliteStatement& bind_blob(int parameter, std::string_view bytes);
  SqliteStatement& bind_null(int parameter);

  /// True when there is a row to read.
  bool step();

  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
  /// Text or blob; empty for NULL.
  std::string bytes(int column) const;

 private:
  void check(int code);
  sqlite3_stmt* statement_;
};

/// One connection. Not thread-safe: its owner holds a lock.
class SqliteConnection {
 public:
  enum class Mode { read_write_create, read_only };
  /// `vfs` names a registered file-system layer; empty for the default one (tests put a faulty one here).
  SqliteConnection(const std::string& path, Mode mode, const std::string& vfs = {});

  /// Statements without parameters or results, separated by semicolons.
  void execute(const std::string& sql);
  /// The statement of this text, prepared on first use and kept; `sql` must be a literal.
  SqliteStatement prepare(const char* sql);
  std::int64_t integer(const char* sql);
  int changes() const { return sqlite3_changes(handle_.get()); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3, Close> handle_;
  std::map<std::string_view, std::unique_ptr<sqlite3_stmt, Finalize>> statements_;
};

/// BEGIN IMMEDIATE … COMMIT; rolls back when it goes out of scope without commit().
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteConnection& connection);
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  ~SqliteTransaction();
  void commit();

 private:
  SqliteConnection& connection_;
  bool open_ = true;
};

}  // namespace toile
