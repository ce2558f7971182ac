#include "server/queue/dispatcher.h"

#include "server/store/digest.h"
#include "server/store/job_id.h"
#include "server/store/sqlite_store.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace toile {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class DispatcherTest : public testing::Test {
 protected:
  void SetUp() override {
    store_ = open_sqlite_store(folder_.path());
    options_.runner = TOILE_SOURCE "/tests/server/queue/fake_run.sh";
    options_.runs = folder_ / "runs";
    options_.heartbeat = 20ms;
    options_.poll = 10ms;
    options_.retry_delay = 1ms;
    options_.grace = 200ms;
  }
  void start() { dispatcher_ = std::make_unique<Dispatcher>(*store_, system_time_ms, options_); }

  /// Queues a job whose fake run does `what`.
  std::string submit(const std::string& what, const std::string& body = "{}") {
    const std::string scene = R"({"garments":[{"name":")" + what + R"("}],"body":)" + body + "}";
    return store_->submit({make_job_id(system_time_ms()), scene, sha256_hex(scene), std::nullopt}, system_time_ms())
        .job.id;
  }

  /// The job once `done` says so, or after ten seconds as it is then.
  template <typename Predicate>
  JobRecord wait_until(const std::string& id, Predicate done) {
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    for (;;) {
      JobRecord job = store_->job(id).value();
      if (done(job) || std::chrono::steady_clock::now() > deadline) return job;
      std::this_thread::sleep_for(2ms);
    }
  }
  JobRecord wait_for_end(const std::string& id) {
    return wait_until(id, [](const JobRecord& job) { return is_final(job.state); });
  }
  JobRecord wait_for_progress(const std::string& id) {
    return wait_until(id, [](const JobRecord& job) { return !job.progress.empty(); });
  }
  bool runs_are_gone() const { return std::filesystem::is_empty(options_.runs); }

  const TemporaryFolder folder_;
  std::unique_ptr<Store> store_;
  DispatcherOptions options_;
  std::unique_ptr<Dispatcher> dispatcher_;
};

TEST_F(DispatcherTest, PublishesWhatARunLeaves) {
  start();
  const std::string id = submit("fine");
  dispatcher_->notify();
  const JobRecord job = wait_for_end(id);
  EXPECT_EQ(job.state, JobState::succeeded);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_EQ(store_->artifact(id, "report.json")->bytes, "{\"status\":\"converged\"}\n");
  EXPECT_EQ(store_->artifact(id, "mesh.obj")->media_type, "model/obj");
  EXPECT_FALSE(store_->artifact(id, "unknown.txt")) << "only files that the service knows are taken";
  EXPECT_FALSE(store_->artifact(id, "preview-link.png")) << "links are not followed";
  dispatcher_->stop();
  EXPECT_TRUE(runs_are_gone());
}

TEST_F(DispatcherTest, HandsAssetsToTheRun) {
  start();
  const std::string bytes = "v 1 2 3\n";
  store_->put_asset(sha256_hex(bytes), bytes, 1);
  const std::string id = submit("assets", R"({"mesh":{"asset":"sha256:)" + sha256_hex(bytes) + "\"}}");
  EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
  EXPECT_EQ(store_->artifact(id, "mesh.glb")->bytes, bytes);
}

TEST_F(DispatcherTest, BadInputFailsAtOnceWithTheRunsProblem) {
  start();
  const JobRecord job = wait_for_end(submit("bad-input"));
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_THAT(job.problem, HasSubstr("/garments/0"));
}

TEST_F(DispatcherTest, NotConvergedFailsButKeepsItsResults) {
  start();
  const JobRecord job = wait_for_end(submit("not-converged"));
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_THAT(job.problem, HasSubstr("not_converged"));
  EXPECT_TRUE(store_->artifact(job.id, "report.json"));
  EXPECT_TRUE(store_->artifact(job.id, "mesh.obj"));
}

TEST_F(DispatcherTest, ACrashIsTriedThreeTimes) {
  start();
  const std::string id = submit("crash");
  const JobRecord job = wait_for_end(id);
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_EQ(job.attempts, kMaxAttempts);
  EXPECT_THAT(job.problem, HasSubstr("signal 11"));
  EXPECT_THAT(job.problem, HasSubstr("out of cheese"));
  EXPECT_TRUE(dispatcher_->is_healthy());
}

TEST_F(DispatcherTest, SuccessWithoutAReportIsADeath) {
  start();
  const JobRecord job = wait_for_end(submit("silent-success"));
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_THAT(job.problem, HasSubstr("without a report"));
}

TEST_F(DispatcherTest, ARunnerThatIsNotThereFailsTheJobWithTheReason) {
  options_.runner = "/nowhere/toile";
  start();
  const JobRecord job = wait_for_end(submit("fine"));
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_THAT(job.problem, HasSubstr("/nowhere/toile"));
}

TEST_F(DispatcherTest, TooLongARunIsKilledAndNotRepeated) {
  options_.wall_limit = 100ms;
  start();
  const JobRecord job = wait_for_end(submit("stubborn"));
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_EQ(job.attempts, 1);
  EXPECT_THAT(job.problem, HasSubstr("run_too_long"));
}

TEST_F(DispatcherTest, CancelsARunningJob) {
  options_.heartbeat = 60s;  // so that it is the notice, not the period, that brings the cancellation
  start();
  const std::string id = submit("hang");
  wait_until(id, [](const JobRecord& job) { return job.state == JobState::running; });
  EXPECT_EQ(store_->cancel(id, system_time_ms()), CancelOutcome::requested);
  dispatcher_->notify();
  const auto started = std::chrono::steady_clock::now();
  EXPECT_EQ(wait_for_end(id).state, JobState::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - started, 5s);
}

TEST_F(DispatcherTest, KillsARunThatIgnoresTheRequest) {
  start();
  const std::string id = submit("stubborn");
  wait_for_progress(id);
  store_->cancel(id, system_time_ms());
  EXPECT_EQ(wait_for_end(id).state, JobState::cancelled);
}

TEST_F(DispatcherTest, TellsProgressWhileItRuns) {
  start();
  const std::string id = submit("hang");
  EXPECT_THAT(wait_for_progress(id).progress, HasSubstr("\"stage\":\"drape\""));
}

TEST_F(DispatcherTest, AnEndlessLineDoesNotStopARun) {
  start();
  EXPECT_EQ(wait_for_end(submit("babble")).state, JobState::succeeded);
}

TEST_F(DispatcherTest, StoppingTheServerPutsItsRunsBack) {
  start();
  const std::string id = submit("hang");
  wait_for_progress(id);
  dispatcher_->stop();
  const JobRecord job = store_->job(id).value();
  EXPECT_EQ(job.state, JobState::queued);
  EXPECT_EQ(job.attempts, 0);
  EXPECT_TRUE(runs_are_gone());
}

TEST_F(DispatcherTest, ResultsUnderALostLeaseAreVoid) {
  start();
  const std::string id = submit("stubborn");
  wait_for_progress(id);
  EXPECT_EQ(store_->release_all_leases(system_time_ms()),
            1);  // as another process would after this one was taken for dead
  const JobRecord job = wait_until(id, [](const JobRecord& now) { return now.attempts == 2; });
  EXPECT_EQ(job.attempts, 2);
  EXPECT_EQ(job.state, JobState::running);
}

TEST_F(DispatcherTest, RunsTwoJobsAtOnce) {
  options_.workers = 2;
  start();
  const std::string first = submit("hang"), second = submit("hang"), third = submit("fine");
  wait_for_progress(first);
  wait_for_progress(second);
  EXPECT_EQ(store_->job(first)->state, JobState::running);
  EXPECT_EQ(store_->job(second)->state, JobState::running);
  EXPECT_EQ(store_->job(third)->state, JobState::queued) << "there are only two workers";
}

TEST_F(DispatcherTest, LimitsTheMemoryOfARun) {
  options_.limits.address_space_bytes = std::uint64_t{512} << 20;
  start();
  const std::string id = submit("limits");
  EXPECT_EQ(wait_for_end(id).state, JobState::succeeded);
  EXPECT_EQ(store_->artifact(id, "mesh.glb")->bytes, std::to_string(512 * 1024) + "\n");
}

TEST_F(DispatcherTest, EmptiesTheRunsOfTheProcessBefore) {
  std::filesystem::create_directories(options_.runs / "left-behind/out");
  start();
  EXPECT_FALSE(std::filesystem::exists(options_.runs / "left-behind"));
}

TEST(RunChild, TellsTheExitStatusAndTheErrorStream) {
  const ChildEnd end = run_child({{"/bin/sh", "-c", "echo woe >&2; exit 7"}, "/", {}}, {});
  EXPECT_EQ(end.how, ChildEnd::How::exited);
  EXPECT_EQ(end.code, 7);
  EXPECT_EQ(end.stderr_tail, "woe\n");
}

TEST(RunChild, KillsWhatTheChildLeftBehind) {
  std::string descendant;
  ChildWatch watch;
  watch.on_line = [&](std::string_view line) { descendant = line; };
  run_child({{"/bin/sh", "-c", "sleep 300 >/dev/null 2>&1 3>&- & echo $! >&3; exit 0"}, "/", {}}, watch);
  ASSERT_NE(descendant, "");
  // The kernel takes a moment to end it; then it is a zombie until init has reaped it.
  const auto state_of = [&] {
    std::ifstream status("/proc/" + descendant + "/stat");
    std::string pid, name, state = "gone";
    status >> pid >> name >> state;
    return state;
  };
  std::string state = state_of();
  for (int i = 0; i < 200 && state != "Z" && state != "gone"; ++i, state = state_of()) {
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_TRUE(state == "Z" || state == "gone") << state;
}

TEST(RunChild, InheritsNoOtherDescriptor) {
  std::string listing;
  ChildWatch watch;
  watch.on_line = [&](std::string_view line) { listing += std::string(line) + " "; };
  run_child({{"/bin/sh", "-c", "for f in /proc/$$/fd/*; do echo ${f##*/} >&3; done"}, "/", {}}, watch);
  EXPECT_THAT(listing, HasSubstr("0 1 2 3"));
  EXPECT_THAT(listing, testing::Not(HasSubstr(" 4 5")));
}

}  // namespace
}  // namespace toile
