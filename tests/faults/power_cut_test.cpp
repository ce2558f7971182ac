// A kill -9 can't show a wrong `synchronous`, for the kernel still has the writes; a power cut can.

#include "server/store/digest.h"
#include "server/store/job_id.h"
#include "server/store/sqlite_connection.h"
#include "server/store/sqlite_store.h"
#include "tests/faults/power_cut_vfs.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <random>

namespace toile {
namespace {

class PowerCut : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(before_);
    install_power_cut_vfs();
  }

  const TemporaryFolder folder_;
  const std::string before_ = folder_ / "before", after_ = folder_ / "after";
};

TEST_F(PowerCut, LosesNothingThatTheStoreAcknowledged) {
  const auto store = open_sqlite_store(before_, kPowerCutVfs);
  std::mt19937 random(7);
  std::vector<std::string> assets, finished;
  constexpr int kRounds = 60;
  for (int round = 0; round < kRounds; ++round) {
    const std::string bytes(1 + random() % 20'000, static_cast<char>('a' + round % 26));
    const std::string name = sha256_hex(bytes + std::to_string(round));
    store->put_asset(name, bytes, round);
    assets.push_back(name);
    const std::string id = make_job_id(round);
    store->submit({id, "{}", sha256_hex(id), std::nullopt}, round);
    const Lease lease = store->lease(round, 1000).value();
    ASSERT_TRUE(store->publish(lease, JobState::succeeded, "", {{"mesh.obj", "model/obj", name, bytes}}, round));
    finished.push_back(id);

    copy_after_power_cut(before_, after_, random() % (unsynced_changes() + 1));
    const auto survivor = open_sqlite_store(after_);
    for (const std::string& asset : assets) ASSERT_TRUE(survivor->has_asset(asset)) << "round " << round;
    for (const std::string& job : finished) {
      ASSERT_EQ(survivor->job(job).value().state, JobState::succeeded) << "round " << round;
      ASSERT_TRUE(survivor->artifact(job, "mesh.obj")) << "round " << round;
    }
  }
}

TEST_F(PowerCut, WouldShowALossAtSynchronousNormal) {
  SqliteConnection connection(before_ + "/plain.sqlite3", SqliteConnection::Mode::read_write_create, kPowerCutVfs);
  connection.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; CREATE TABLE acknowledged (n INTEGER)");
  connection.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  constexpr int kCommits = 10;
  for (int i = 0; i < kCommits; ++i) connection.execute("INSERT INTO acknowledged VALUES (1)");
  copy_after_power_cut(before_, after_, 0);
  SqliteConnection survivor(after_ + "/plain.sqlite3", SqliteConnection::Mode::read_write_create);
  EXPECT_LT(survivor.integer("SELECT count(*) FROM acknowledged"), kCommits)
      << "if nothing is lost here, the test above proves nothing";
}

}  // namespace
}  // namespace toile
