#include "tests/server/store/store_contract.h"

#include "server/store/digest.h"
#include "server/store/job_id.h"

#include <gmock/gmock.h>

#include <atomic>
#include <set>
#include <thread>

namespace toile {
namespace {

constexpr TimeMs kLease = 30'000;

NewJob new_job(const std::string& scene) { return {make_job_id(1000), scene, sha256_hex(scene), std::nullopt}; }

Artifact artifact(const std::string& name, const std::string& bytes) {
  return {name, "application/octet-stream", sha256_hex(bytes), bytes};
}

}  // namespace

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(StoreContract);

void StoreContract::SetUp() { store_ = GetParam()(folder_.path()); }

void StoreContract::reopen() {
  store_.reset();
  store_ = GetParam()(folder_.path());
}

JobRecord StoreContract::submit(int number, TimeMs now) {
  return store_->submit(new_job("{\"n\":" + std::to_string(number) + "}"), now).job;
}

TEST_P(StoreContract, KeepsAssetsUnderTheirDigest) {
  const std::string bytes("v 0 0 0\n\0binary", 15);
  const std::string name = sha256_hex(bytes);
  EXPECT_FALSE(store_->has_asset(name));
  EXPECT_EQ(store_->asset(name), std::nullopt);
  EXPECT_TRUE(store_->put_asset(name, bytes, 1));
  EXPECT_FALSE(store_->put_asset(name, bytes, 2)) << "the second time it is there already";
  EXPECT_TRUE(store_->has_asset(name));
  EXPECT_EQ(store_->asset(name), bytes);
  reopen();
  EXPECT_EQ(store_->asset(name), bytes);
}

TEST_P(StoreContract, KeepsAnEmptyAsset) {
  EXPECT_TRUE(store_->put_asset(sha256_hex(""), "", 1));
  EXPECT_EQ(store_->asset(sha256_hex("")), "");
}

TEST_P(StoreContract, QueuesInOrderOfSubmission) {
  const JobRecord first = submit(1), second = submit(2);
  EXPECT_EQ(first.state, JobState::queued);
  EXPECT_EQ(first.place_in_queue, 1);
  EXPECT_EQ(second.place_in_queue, 2);
  EXPECT_EQ(store_->queued_jobs(), 2);
  const auto lease = store_->lease(2000, kLease);
  ASSERT_TRUE(lease);
  EXPECT_EQ(lease->job_id, first.id);
  EXPECT_EQ(lease->scene, "{\"n\":1}");
  EXPECT_EQ(lease->attempt, 1);
  EXPECT_EQ(store_->job(second.id)->place_in_queue, 1);
  const JobRecord running = store_->job(first.id).value();
  EXPECT_EQ(running.state, JobState::running);
  EXPECT_EQ(running.started, 2000);
  EXPECT_EQ(running.place_in_queue, 0);
}

TEST_P(StoreContract, KnowsNoOtherJob) {
  EXPECT_EQ(store_->job(make_job_id(1)), std::nullopt);
  EXPECT_EQ(store_->lease(1, kLease), std::nullopt);
  EXPECT_EQ(store_->cancel(make_job_id(1), 1), CancelOutcome::unknown_job);
  EXPECT_EQ(store_->artifact(make_job_id(1), "report.json"), std::nullopt);
}

TEST_P(StoreContract, RepeatsASubmissionUnderItsKey) {
  NewJob job = new_job("{}");
  job.idempotency_key = "order-7";
  const Submission first = store_->submit(job, 1000);
  EXPECT_EQ(first.kind, Submission::Kind::created);
  job.id = make_job_id(1001);
  const Submission again = store_->submit(job, 1001);
  EXPECT_EQ(again.kind, Submission::Kind::repeated);
  EXPECT_EQ(again.job.id, first.job.id);
  job.fingerprint = sha256_hex("other");
  EXPECT_EQ(store_->submit(job, 1002).kind, Submission::Kind::key_reused);
  EXPECT_EQ(store_->queued_jobs(), 1);
}

TEST_P(StoreContract, PublishesResultsAllAtOnce) {
  const JobRecord job = submit(1);
  const Lease lease = store_->lease(2000, kLease).value();
  EXPECT_EQ(store_->artifact(job.id, "report.json"), std::nullopt);
  EXPECT_TRUE(store_->publish(lease, JobState::succeeded, "",
                              {artifact("report.json", "{}"), artifact("mesh.obj", "v")}, 5000));
  reopen();
  const JobRecord done = store_->job(job.id).value();
  EXPECT_EQ(done.state, JobState::succeeded);
  EXPECT_EQ(done.finished, 5000);
  EXPECT_EQ(store_->artifact(job.id, "mesh.obj")->bytes, "v");
  EXPECT_EQ(store_->artifact(job.id, "report.json")->sha256, sha256_hex("{}"));
  EXPECT_EQ(store_->lease(6000, kLease), std::nullopt) << "a finished job is not leased again";
}

TEST_P(StoreContract, RefusesResultsUnderAStaleToken) {
  const JobRecord job = submit(1);
  const Lease slow = store_->lease(1000, kLease).value();
  const Lease fresh = store_->lease(1000 + kLease + 1, kLease).value();
  EXPECT_EQ(fresh.job_id, job.id);
  EXPECT_EQ(fresh.attempt, 2);
  EXPECT_GT(fresh.token, slow.token);

  EXPECT_FALSE(store_->publish(slow, JobState::succeeded, "", {artifact("mesh.obj", "stale")}, 40'000));
  EXPECT_EQ(store_->artifact(job.id, "mesh.obj"), std::nullopt) << "nothing of a stale attempt is kept";
  EXPECT_EQ(store_->heartbeat(slow, "{}", 40'000, kLease), LeaseState::lost);
  EXPECT_FALSE(store_->give_up(slow, "it crashed", 40'000, 40'000));
  EXPECT_FALSE(store_->hand_back(slow, 40'000));
  EXPECT_EQ(store_->job(job.id)->state, JobState::running);

  EXPECT_TRUE(store_->publish(fresh, JobState::succeeded, "", {artifact("mesh.obj", "fresh")}, 41'000));
  EXPECT_EQ(store_->artifact(job.id, "mesh.obj")->bytes, "fresh");
  EXPECT_FALSE(store_->publish(fresh, JobState::failed, "{}", {}, 42'000)) << "a job ends once";
}

TEST_P(StoreContract, AHeartbeatProlongsTheLeaseAndTellsProgress) {
  const JobRecord job = submit(1);
  const Lease lease = store_->lease(1000, kLease).value();
  EXPECT_EQ(store_->heartbeat(lease, R"({"stage":"drape"})", 20'000, kLease), LeaseState::held);
  EXPECT_EQ(store_->heartbeat(lease, "", 21'000, kLease), LeaseState::held);
  EXPECT_EQ(store_->job(job.id)->progress, R"({"stage":"drape"})");
  EXPECT_EQ(store_->lease(1000 + kLease + 1, kLease), std::nullopt);
  EXPECT_EQ(store_->lease(21'000 + kLease, kLease), std::nullopt) << "the deadline itself still holds";
  EXPECT_TRUE(store_->lease(21'000 + kLease + 1, kLease));
}

TEST_P(StoreContract, TriesThreeTimesThenFailsWithTheReason) {
  const JobRecord job = submit(1);
  for (int attempt = 1; attempt <= kMaxAttempts; ++attempt) {
    const Lease lease = store_->lease(1000 * attempt, kLease).value();
    EXPECT_EQ(lease.attempt, attempt);
    EXPECT_TRUE(store_->give_up(lease, "signal 11", 1000 * attempt + 1, 1000 * attempt + 1));
    if (attempt < kMaxAttempts) {
      EXPECT_EQ(store_->job(job.id)->last_failure, "signal 11");
    }
  }
  const JobRecord failed = store_->job(job.id).value();
  EXPECT_EQ(failed.state, JobState::failed);
  EXPECT_EQ(failed.attempts, kMaxAttempts);
  EXPECT_THAT(failed.problem, testing::HasSubstr("signal 11"));
  EXPECT_THAT(failed.problem, testing::HasSubstr("run_died"));
  EXPECT_EQ(store_->lease(1'000'000, kLease), std::nullopt);
}

TEST_P(StoreContract, WaitsBeforeItTriesAgain) {
  submit(1);
  const Lease lease = store_->lease(1000, kLease).value();
  store_->give_up(lease, "signal 9", 1000, 5000);
  EXPECT_EQ(store_->lease(4999, kLease), std::nullopt);
  EXPECT_TRUE(store_->lease(5000, kLease));
}

TEST_P(StoreContract, LeasesThatRunOutCostAnAttemptEach) {
  const JobRecord job = submit(1);
  TimeMs now = 0;
  for (int attempt = 1; attempt <= kMaxAttempts; ++attempt, now += kLease + 1) ASSERT_TRUE(store_->lease(now, kLease));
  EXPECT_EQ(store_->lease(now, kLease), std::nullopt);
  EXPECT_EQ(store_->job(job.id)->state, JobState::failed);
}

TEST_P(StoreContract, AnOrderlyShutdownCostsNoAttempt) {
  const JobRecord job = submit(1);
  for (int round = 0; round < 2 * kMaxAttempts; ++round) {
    const Lease lease = store_->lease(1000, kLease).value();
    EXPECT_EQ(lease.attempt, 1);
    EXPECT_TRUE(store_->hand_back(lease, 1000));
  }
  EXPECT_EQ(store_->job(job.id)->state, JobState::queued);
}

TEST_P(StoreContract, AProcessThatDiedLosesItsLeases) {
  const JobRecord job = submit(1), other = submit(2);
  const Lease dead = store_->lease(1000, kLease).value();
  reopen();
  EXPECT_EQ(store_->job(job.id)->state, JobState::running);
  EXPECT_EQ(store_->release_all_leases(1001), 1);
  EXPECT_EQ(store_->release_all_leases(1002), 0);
  EXPECT_EQ(store_->heartbeat(dead, "", 1003, kLease), LeaseState::lost);
  const Lease again = store_->lease(1004, kLease).value();
  EXPECT_EQ(again.job_id, job.id);
  EXPECT_EQ(again.attempt, 2);
}

TEST_P(StoreContract, CancelsAQueuedJobAtOnce) {
  const JobRecord job = submit(1);
  EXPECT_EQ(store_->cancel(job.id, 2000), CancelOutcome::cancelled);
  EXPECT_EQ(store_->job(job.id)->state, JobState::cancelled);
  EXPECT_EQ(store_->job(job.id)->finished, 2000);
  EXPECT_EQ(store_->lease(3000, kLease), std::nullopt);
  EXPECT_EQ(store_->cancel(job.id, 4000), CancelOutcome::already_final);
}

TEST_P(StoreContract, TellsARunningJobToStop) {
  const JobRecord job = submit(1);
  const Lease lease = store_->lease(1000, kLease).value();
  EXPECT_EQ(store_->cancel(job.id, 2000), CancelOutcome::requested);
  EXPECT_EQ(store_->job(job.id)->state, JobState::running);
  EXPECT_EQ(store_->heartbeat(lease, "", 2001, kLease), LeaseState::cancel_requested);
  EXPECT_TRUE(store_->publish(lease, JobState::cancelled, "", {}, 2002));
  EXPECT_EQ(store_->job(job.id)->state, JobState::cancelled);
}

TEST_P(StoreContract, ACrashOfAJobThatWasAskedToStopEndsIt) {
  const JobRecord job = submit(1);
  const Lease lease = store_->lease(1000, kLease).value();
  store_->cancel(job.id, 2000);
  EXPECT_TRUE(store_->give_up(lease, "signal 15", 2001, 2001));
  EXPECT_EQ(store_->job(job.id)->state, JobState::cancelled);
}

TEST_P(StoreContract, PagesFromTheNewestWithoutGapOrRepeat) {
  std::vector<std::string> expected;
  for (int i = 0; i < 7; ++i) expected.insert(expected.begin(), submit(i).id);
  std::vector<std::string> seen;
  std::string cursor;
  int pages = 0;
  do {
    const JobPage page = store_->jobs(std::nullopt, cursor, 3);
    for (const JobRecord& job : page.jobs) seen.push_back(job.id);
    cursor = page.next_cursor;
    submit(100 + pages);  // a newcomer must not shift the pages
  } while (!cursor.empty() && ++pages < 10);
  EXPECT_EQ(seen, expected);
}

TEST_P(StoreContract, FiltersPagesByState) {
  const JobRecord first = submit(1), second = submit(2), third = submit(3);
  store_->cancel(second.id, 2000);
  const JobPage page = store_->jobs(JobState::cancelled, "", 10);
  ASSERT_EQ(page.jobs.size(), 1U);
  EXPECT_EQ(page.jobs[0].id, second.id);
  EXPECT_EQ(page.next_cursor, "");
  EXPECT_EQ(store_->jobs(JobState::queued, third.id, 10).jobs.at(0).id, first.id);
  EXPECT_TRUE(store_->jobs(std::nullopt, make_job_id(5), 10).jobs.empty());
}

TEST_P(StoreContract, AddsAPictureOnce) {
  const JobRecord job = submit(1);
  store_->publish(store_->lease(1000, kLease).value(), JobState::succeeded, "", {}, 2000);
  store_->add_artifact(job.id, artifact("preview-top.png", "first"));
  store_->add_artifact(job.id, artifact("preview-top.png", "second"));
  EXPECT_EQ(store_->artifact(job.id, "preview-top.png")->bytes, "first") << "what was served once stays as it is";
}

TEST_P(StoreContract, GivesAJobToOneWorkerOnly) {
  constexpr int kJobs = 40, kThreads = 4;
  for (int i = 0; i < kJobs; ++i) submit(i);
  std::vector<std::vector<std::string>> taken(kThreads);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      while (const auto lease = store_->lease(2000, kLease)) {
        taken[static_cast<std::size_t>(t)].push_back(lease->job_id);
        store_->publish(*lease, JobState::succeeded, "", {}, 2001);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::set<std::string> distinct;
  std::size_t total = 0;
  for (const auto& list : taken) {
    total += list.size();
    distinct.insert(list.begin(), list.end());
  }
  EXPECT_EQ(total, static_cast<std::size_t>(kJobs));
  EXPECT_EQ(distinct.size(), static_cast<std::size_t>(kJobs));
}

TEST_P(StoreContract, ChecksItselfWithoutATrace) {
  const JobRecord job = submit(1);
  EXPECT_NO_THROW(store_->check());
  EXPECT_EQ(store_->job(job.id)->attempts, 0);
}

}  // namespace toile
