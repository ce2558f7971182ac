#include "server/store/sqlite_store.h"

#include "server/store/digest.h"
#include "server/store/job_id.h"
#include "server/store/sqlite_connection.h"
#include "tests/server/store/store_contract.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

#include <fstream>

namespace toile {
namespace {

INSTANTIATE_TEST_SUITE_P(Sqlite, StoreContract, testing::Values(StoreMaker([](const std::string& folder) {
                           return open_sqlite_store(folder);
                         })),
                         [](const auto&) { return std::string("InAFile"); });

class SqliteStoreFile : public testing::Test {
 protected:
  std::string database() const { return folder_ / "toile.sqlite3"; }
  const TemporaryFolder folder_;
};

TEST_F(SqliteStoreFile, TheLiveConnectionSyncsEveryCommit) {
  const auto store = open_sqlite_store(folder_.path());
  const SqliteDurability durability = sqlite_durability(*store);
  EXPECT_EQ(durability.journal_mode, "wal");
  EXPECT_EQ(durability.synchronous, 2) << "2 is FULL; NORMAL loses acknowledged commits at a power cut";
}

TEST_F(SqliteStoreFile, ASecondProcessIsKeptOut) {
  const auto store = open_sqlite_store(folder_.path());
  EXPECT_THROW(open_sqlite_store(folder_.path()), StoreError);
}

TEST_F(SqliteStoreFile, TablesAreStrict) {
  { const auto store = open_sqlite_store(folder_.path()); }
  SqliteConnection connection(database(), SqliteConnection::Mode::read_only);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM pragma_table_list WHERE name IN ('jobs', 'assets', 'artifacts') "
                               "AND strict = 1"),
            3);
  EXPECT_EQ(connection.integer("PRAGMA user_version"), 1);
}

TEST_F(SqliteStoreFile, ANewerFileIsLeftAlone) {
  { const auto store = open_sqlite_store(folder_.path()); }
  {
    SqliteConnection connection(database(), SqliteConnection::Mode::read_write_create);
    connection.execute("PRAGMA user_version = 99");
  }
  EXPECT_THROW(open_sqlite_store(folder_.path()), StoreError);
}

TEST_F(SqliteStoreFile, AnotherProgramsFileIsLeftAlone) {
  {
    SqliteConnection connection(database(), SqliteConnection::Mode::read_write_create);
    connection.execute("CREATE TABLE orders (id INTEGER)");
  }
  EXPECT_THROW(open_sqlite_store(folder_.path()), StoreError);
}

TEST_F(SqliteStoreFile, RubbishIsRefused) {
  std::ofstream(database()) << std::string(8192, 'x');
  EXPECT_THROW(open_sqlite_store(folder_.path()), StoreError);
}

TEST_F(SqliteStoreFile, AFullDatabaseSaysSoAndKeepsWhatItHas) {
  const auto store = open_sqlite_store(folder_.path());
  ASSERT_TRUE(store->put_asset(sha256_hex("small"), "small", 1));
  EXPECT_EQ(store->asset(sha256_hex("small")), "small");
  const std::string beyond(std::size_t{1'000'000'001}, 'x');  // SQLite's limit on one value
  try {
    store->put_asset("beyond", beyond, 2);
    FAIL() << "stored what can't be stored";
  } catch (const StoreError& error) {
    EXPECT_EQ(error.kind(), StoreError::Kind::full);
  }
  EXPECT_EQ(store->asset(sha256_hex("small")), "small");
  EXPECT_FALSE(store->has_asset("beyond"));
}

}  // namespace

TEST(Digest, OfKnownText) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest_of_asset_name("sha256:" + sha256_hex("abc")), sha256_hex("abc"));
  EXPECT_EQ(digest_of_asset_name("sha256:../../etc/passwd"), "");
  EXPECT_EQ(digest_of_asset_name("md5:abc"), "");
}

TEST(JobId, IsAUuidOfVersion7ThatSortsByTime) {
  const std::string early = make_job_id(1'700'000'000'000), late = make_job_id(1'700'000'000'001);
  EXPECT_THAT(early, testing::MatchesRegex("[0-9a-f]{8}-[0-9a-f]{4}-7[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
  EXPECT_LT(early, late);
  EXPECT_NE(make_job_id(5), make_job_id(5));
  EXPECT_TRUE(is_job_id(early));
  EXPECT_FALSE(is_job_id("../" + early));
  EXPECT_FALSE(is_job_id(early.substr(1)));
}

}  // namespace toile
