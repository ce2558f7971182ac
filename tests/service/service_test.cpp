// The main job by curl against a real server, and what is left when things die in the middle.

#include "tests/service/service_process.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace toile {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

// A napkin on a ball, 133 vertices: at rest within a second.
const std::string kQuickScene = R"({"garments":[{"rectangle":{"width_mm":300,"height_mm":300},"edge_length_mm":30,)"
                                R"("transform":{"translate_mm":[0,270,0]}}],)"
                                R"("body":{"sphere":{"radius_mm":150,"center_mm":[0,100,0]}},"fidelity":"standard",)"
                                R"("render":{"views":["front"],"size_px":[64,64]}})";
// Fine cloth that never stops early: a minute at least, to be ended by the test.
const std::string kSlowScene = R"({"garments":[{"disc":{"radius_mm":500},"edge_length_mm":8,)"
                               R"("transform":{"translate_mm":[0,270,0]}}],)"
                               R"("body":{"sphere":{"radius_mm":150,"center_mm":[0,100,0]}},"fidelity":"reference",)"
                               R"("render":{"views":[]}})";

class ServiceOverCurl : public testing::Test {
 protected:
  std::string data() const { return folder_ / "data"; }

  /// The run of a job that is under way; waits for it.
  static pid_t run_of(const ServiceProcess& server) {
    for (int i = 0; i < 500; ++i) {
      const std::vector<pid_t> runs = server.runs();
      if (!runs.empty()) return runs[0];
      std::this_thread::sleep_for(10ms);
    }
    return -1;
  }
  static bool ends_within(pid_t pid, std::chrono::seconds patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (is_alive(pid) && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(10ms);
    return !is_alive(pid);
  }

  const TemporaryFolder folder_;
};

TEST_F(ServiceOverCurl, SubmitPollFetchList) {
  const ServiceProcess server(data());
  const std::string id = server.submit(kQuickScene);
  const json job = server.wait_for(id, "succeeded");
  ASSERT_EQ(job["state"], "succeeded") << job;
  const std::string self = "/v1/jobs/" + id;

  const json report = server.curl(self + "/report").json();
  EXPECT_EQ(report["status"], "converged");
  EXPECT_GT(report["vertices"], 50);
  EXPECT_THAT(server.curl(self + "/mesh.obj").body, HasSubstr("\nf "));
  EXPECT_EQ(server.curl(self + "/mesh.glb").body.substr(0, 4), "glTF");
  EXPECT_EQ(server.curl(self + "/preview.png").body.substr(1, 3), "PNG");
  const CurlAnswer drawn = server.curl(self + "/preview.png?view=top&overlay=stretch");
  EXPECT_EQ(drawn.status, 200) << drawn.body;
  EXPECT_EQ(drawn.body.substr(1, 3), "PNG");

  const json list = server.curl("/v1/jobs?state=succeeded").json();
  ASSERT_EQ(list["jobs"].size(), 1U);
  EXPECT_EQ(list["jobs"][0]["id"], id);
  EXPECT_EQ(server.curl("/healthz").status, 200);
}

TEST_F(ServiceOverCurl, AnUploadedMeshIsUsedByItsDigest) {
  const ServiceProcess server(data());
  const std::string file = folder_ / "tetrahedron.obj";
  std::ofstream(file) << "v -0.2 0 -0.2\nv 0.2 0 -0.2\nv 0 0 0.3\nv 0 0.25 0\n"
                         "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  const CurlAnswer uploaded = server.curl("/v1/assets", "--data-binary @" + file);
  ASSERT_EQ(uploaded.status, 201) << uploaded.body;
  const std::string scene = R"({"garments":[{"rectangle":{"width_mm":300,"height_mm":300},"edge_length_mm":30,)"
                            R"("transform":{"translate_mm":[0,300,0]}}],"fidelity":"preview","render":{"views":[]},)"
                            R"("body":{"mesh":{"asset":")" +
                            uploaded.json()["asset"].get<std::string>() + R"("}}})";
  const json job = server.wait_for(server.submit(scene), "succeeded");
  EXPECT_EQ(job["state"], "succeeded") << job;
}

TEST_F(ServiceOverCurl, TwoJobsAtOnceGiveTheSameBytes) {
  const ServiceProcess server(data(), {"--workers", "2"});
  const std::string first = server.submit(kQuickScene), second = server.submit(kQuickScene);
  EXPECT_NE(first, second);
  EXPECT_EQ(server.wait_for(first, "succeeded")["state"], "succeeded");
  EXPECT_EQ(server.wait_for(second, "succeeded")["state"], "succeeded");
  EXPECT_EQ(server.curl("/v1/jobs/" + first + "/mesh.obj").body, server.curl("/v1/jobs/" + second + "/mesh.obj").body);
}

TEST_F(ServiceOverCurl, CancelsARun) {
  const ServiceProcess server(data());
  const std::string id = server.submit(kSlowScene);
  const pid_t run = run_of(server);
  ASSERT_GT(run, 0);
  EXPECT_EQ(server.curl("/v1/jobs/" + id + "/mesh.obj").status, 409);
  EXPECT_EQ(server.curl("/v1/jobs/" + id, "-X DELETE").status, 202);
  EXPECT_EQ(server.wait_for(id, "cancelled", 15)["state"], "cancelled");
  EXPECT_TRUE(ends_within(run, 2s));
}

TEST_F(ServiceOverCurl, ARunThatIsKilledIsTriedAgainThenFailed) {
  const ServiceProcess server(data());
  const std::string id = server.submit(kSlowScene);
  pid_t last = -1;
  for (int attempt = 1; attempt <= 3; ++attempt) {
    pid_t run = run_of(server);
    for (int i = 0; i < 300 && (run == last || run < 0); ++i, run = run_of(server)) std::this_thread::sleep_for(10ms);
    ASSERT_GT(run, 0);
    EXPECT_EQ(server.curl("/v1/jobs/" + id).json()["attempts"], attempt);
    kill(run, SIGKILL);
    last = run;
  }
  const json job = server.wait_for(id, "failed", 15);
  EXPECT_EQ(job["state"], "failed");
  EXPECT_THAT(job["error"]["detail"].get<std::string>(), HasSubstr("signal 9"));
  EXPECT_EQ(server.curl("/healthz").status, 200);
}

TEST_F(ServiceOverCurl, AKilledServerLosesNothingAndItsRunEnds) {
  std::string finished, under_way, waiting;
  pid_t run = -1;
  {
    ServiceProcess server(data());
    finished = server.submit(kQuickScene);
    EXPECT_EQ(server.wait_for(finished, "succeeded")["state"], "succeeded");
    under_way = server.submit(kSlowScene);
    run = run_of(server);
    ASSERT_GT(run, 0);
    waiting = server.submit(kQuickScene);
    server.kill_now();
  }
  EXPECT_TRUE(ends_within(run, 5s)) << "a run must not outlive its server";

  const ServiceProcess server(data());
  EXPECT_EQ(server.curl("/v1/jobs/" + finished).json()["state"], "succeeded");
  EXPECT_THAT(server.curl("/v1/jobs/" + finished + "/mesh.obj").body, HasSubstr("\nf "));
  const json again = server.wait_for(under_way, "running", 15);
  EXPECT_EQ(again["state"], "running");
  EXPECT_EQ(again["attempts"], 2);
  server.curl("/v1/jobs/" + under_way, "-X DELETE");
  EXPECT_EQ(server.wait_for(waiting, "succeeded")["state"], "succeeded");
}

TEST_F(ServiceOverCurl, AnOrderlyStopPutsTheRunBack) {
  std::string id;
  {
    ServiceProcess server(data());
    id = server.submit(kSlowScene);
    ASSERT_GT(run_of(server), 0);
    EXPECT_EQ(server.stop(), 0);
  }
  const ServiceProcess server(data());
  const json job = server.wait_for(id, "running", 15);
  EXPECT_EQ(job["state"], "running");
  EXPECT_EQ(job["attempts"], 1) << "a stop of the server is not the job's fault";
}

TEST_F(ServiceOverCurl, AStopAtAnyMomentOfTheStartIsTaken) {
  for (auto delay = 0ms; delay <= 200ms; delay += 10ms) {
    ASSERT_EQ(status_when_stopped_after(delay, data(), 10s), 0) << "SIGTERM " << delay.count() << " ms after the start";
  }
}

TEST_F(ServiceOverCurl, AServerWithoutAListenerEndsAndSaysSo) {
  ServiceProcess server(data());
  if (!server.break_listener()) GTEST_SKIP() << "this process may not touch another's sockets (pidfd_getfd)";
  EXPECT_EQ(server.wait(), 1);
}

TEST_F(ServiceOverCurl, ASecondServerOnTheSameDataIsRefused) {
  const ServiceProcess server(data());
  int status = 0;
  shell(std::string(TOILE_BINARY) + " serve --port 0 --data " + data() + " 2>&1", &status);
  EXPECT_EQ(status, 1);
}

}  // namespace
}  // namespace toile
