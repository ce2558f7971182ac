#include "server/http/service.h"

#include "schemas/validate.h"
#include "server/http/job_document.h"
#include "server/store/digest.h"
#include "server/store/job_id.h"
#include "tests/server/http/service_fixture.h"

#include <gmock/gmock.h>

namespace toile {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using ServiceTest = ServiceFixture;

const std::vector<std::pair<std::string, std::string>> kJson{{"Content-Type", "application/json"}};

TEST_F(ServiceTest, StoresAnAssetOnce) {
  const Answer first = request("POST", "/v1/assets", "v 0 0 0\n");
  EXPECT_EQ(first.status, 201);
  EXPECT_EQ(first.json()["asset"], "sha256:" + sha256_hex("v 0 0 0\n"));
  const Answer again = request("POST", "/v1/assets", "v 0 0 0\n");
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.json(), first.json());
  EXPECT_EQ(request("POST", "/v1/assets").status, 422);
}

TEST_F(ServiceTest, TakesAJobFromSubmissionToResults) {
  const Answer submitted = submit("fine");
  ASSERT_EQ(submitted.status, 202) << submitted.body;
  const std::string id = submitted.json()["id"], self = "/v1/jobs/" + id;
  EXPECT_EQ(submitted.json()["state"], "queued");
  EXPECT_EQ(submitted.header("Location"), self);
  EXPECT_NO_THROW(validate_document("job.schema.json", submitted.json()));

  const json job = wait_for_end(id);
  EXPECT_EQ(job["state"], "succeeded");
  EXPECT_NO_THROW(validate_document("job.schema.json", job)) << job;
  const Answer report = request("GET", job["links"]["report"]);
  EXPECT_EQ(report.status, 200);
  EXPECT_EQ(report.header("Content-Type"), "application/json");
  const Answer mesh = request("GET", self + "/mesh.obj");
  EXPECT_EQ(mesh.body, "v 0 0 0\n");
  EXPECT_EQ(mesh.header("Content-Type"), "model/obj");
}

TEST_F(ServiceTest, TakesAnExperimentInPlaceOfAScene) {
  const std::string experiment = R"("experiment":{"kind":"pear_loop","fabric":"denim"})";
  const Answer submitted = request("POST", "/v1/jobs", "{" + experiment + "}", kJson);
  ASSERT_EQ(submitted.status, 202) << submitted.body;
  EXPECT_NO_THROW(validate_document("job.schema.json", submitted.json()));

  const Answer wrong =
      request("POST", "/v1/jobs", R"({"experiment":{"kind":"pear_loop","fabric":"denim","disc_mm":300}})", kJson);
  EXPECT_EQ(wrong.status, 422);
  EXPECT_EQ(wrong.json()["errors"][0]["pointer"], "/experiment/disc_mm");
  EXPECT_EQ(wrong.json()["errors"][0]["code"], "key_not_of_kind");
  const Answer both = request("POST", "/v1/jobs", R"({"scene":)" + scene_named("fine") + "," + experiment + "}", kJson);
  EXPECT_EQ(both.status, 422);
  EXPECT_EQ(both.json()["errors"][0]["pointer"], "/scene");
}

TEST_F(ServiceTest, AnImmutableResultIsNotSentTwice) {
  const std::string id = submit("fine").json()["id"];
  wait_for_end(id);
  const std::string path = "/v1/jobs/" + id + "/mesh.obj";
  const std::string etag = request("GET", path).header("ETag");
  EXPECT_EQ(etag, "\"" + sha256_hex("v 0 0 0\n") + "\"");
  const Answer known = request("GET", path, {}, {{"If-None-Match", "W/" + etag}});
  EXPECT_EQ(known.status, 304);
  EXPECT_EQ(known.body, "");
  EXPECT_EQ(request("GET", path, {}, {{"If-None-Match", "\"other\""}}).status, 200);
  const Answer head = request("HEAD", path);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("Content-Length"), "8");
  EXPECT_EQ(head.body, "");
}

TEST_F(ServiceTest, DrawsAPictureOnRequestAndKeepsIt) {
  const std::string id = submit("fine").json()["id"];
  wait_for_end(id);
  const std::string path = "/v1/jobs/" + id + "/preview.png?view=top&overlay=stretch";
  const Answer picture = request("GET", path);
  EXPECT_EQ(picture.status, 200) << picture.body;
  EXPECT_EQ(picture.header("Content-Type"), "image/png");
  EXPECT_EQ(picture.body, "picture top stretch\n");
  EXPECT_TRUE(store_->artifact(id, "preview-top-stretch.png"));
  EXPECT_EQ(request("GET", path).header("ETag"), picture.header("ETag"));
  EXPECT_EQ(request("GET", "/v1/jobs/" + id + "/preview.png?view=inside").status, 400);
  EXPECT_EQ(request("GET", "/v1/jobs/" + id + "/preview.png?overlay=..%2F..%2Fx").status, 400);
}

TEST_F(ServiceTest, ResultsOfAnUnfinishedJobAreAConflict) {
  const std::string id = submit("hang").json()["id"];
  for (const char* result : {"/report", "/mesh.obj", "/mesh.glb", "/preview.png"}) {
    const Answer answer = request("GET", "/v1/jobs/" + id + result);
    EXPECT_EQ(answer.status, 409) << result;
    EXPECT_EQ(answer.json()["errors"][0]["code"], "job_not_finished");
  }
}

TEST_F(ServiceTest, AFailedJobShowsItsProblem) {
  const json job = wait_for_end(submit("bad-input").json()["id"]);
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["error"]["errors"][0]["pointer"], "/garments/0");
  EXPECT_NO_THROW(validate_document("job.schema.json", job)) << job;
  EXPECT_EQ(request("GET", "/v1/jobs/" + job["id"].get<std::string>() + "/report").status, 409);
}

TEST_F(ServiceTest, AJobThatDidNotConvergeKeepsItsReport) {
  const json job = wait_for_end(submit("not-converged").json()["id"]);
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["error"]["errors"][0]["code"], "not_converged");
  EXPECT_EQ(request("GET", "/v1/jobs/" + job["id"].get<std::string>() + "/report").status, 200);
}

TEST_F(ServiceTest, CancelsWhatRunsAndWhatWaits) {
  const std::string running = submit("hang").json()["id"], waiting = submit("fine").json()["id"];
  while (store_->job(running)->state == JobState::queued) std::this_thread::yield();
  const Answer at_once = request("DELETE", "/v1/jobs/" + waiting);
  EXPECT_EQ(at_once.status, 202);
  EXPECT_EQ(at_once.json()["state"], "cancelled");
  EXPECT_EQ(request("DELETE", "/v1/jobs/" + running).status, 202);
  EXPECT_EQ(wait_for_end(running)["state"], "cancelled");
  EXPECT_EQ(request("DELETE", "/v1/jobs/" + running).status, 202) << "asking twice is no error";

  const std::string done = submit("fine").json()["id"];
  wait_for_end(done);
  EXPECT_EQ(request("DELETE", "/v1/jobs/" + done).status, 409);
  EXPECT_EQ(request("DELETE", "/v1/jobs/" + make_job_id(5)).status, 404);
}

TEST_F(ServiceTest, ListsPagesByStateAndCursor) {
  const std::string blocker = submit("hang").json()["id"];
  std::vector<std::string> expected;
  for (int i = 0; i < 5; ++i) expected.insert(expected.begin(), submit("fine").json()["id"]);
  std::vector<std::string> seen;
  std::string cursor;
  do {
    const json page = request("GET", "/v1/jobs?state=queued&limit=2" + cursor).json();
    for (const json& job : page["jobs"]) seen.push_back(job["id"]);
    cursor = page.contains("next_cursor") ? "&cursor=" + page["next_cursor"].get<std::string>() : "";
  } while (!cursor.empty() && seen.size() < 20);
  EXPECT_EQ(seen, expected);
  EXPECT_EQ(request("GET", "/v1/jobs/" + expected.back()).json()["queue_position"], 0);
  for (const char* query : {"state=unknown", "limit=0", "limit=201", "limit=x", "cursor=x", "sort=up"}) {
    EXPECT_EQ(request("GET", std::string("/v1/jobs?") + query).status, 400) << query;
  }
}

TEST_F(ServiceTest, AnIdempotencyKeyMakesOneJob) {
  const std::string body = R"({"scene":)" + scene_named("fine") + "}";
  auto headers = kJson;
  headers.emplace_back("Idempotency-Key", "order-1");
  const Answer first = request("POST", "/v1/jobs", body, headers);
  const Answer again = request("POST", "/v1/jobs", body, headers);
  EXPECT_EQ(first.status, 202);
  EXPECT_EQ(again.status, 202);
  EXPECT_EQ(again.json()["id"], first.json()["id"]);
  EXPECT_EQ(request("POST", "/v1/jobs", R"({"scene":)" + scene_named("other") + "}", headers).status, 422);
}

TEST_F(ServiceTest, AFullQueueSaysWhenToComeBack) {
  service_->options.max_queued = 1;
  submit("hang");
  int status = 0;
  for (int i = 0; i < 3 && status != 429; ++i) {
    const Answer answer = submit("fine");
    status = answer.status;
    if (status == 429) {
      EXPECT_EQ(answer.header("Retry-After"), "30");
    }
  }
  EXPECT_EQ(status, 429);
}

struct BadScene {
  const char* name;
  std::string body;
  int status;
  const char* code;
  const char* pointer;
};

class BadSceneTest : public ServiceFixture, public testing::WithParamInterface<BadScene> {};

TEST_P(BadSceneTest, IsRefusedWithItsPlace) {
  const Answer answer = request("POST", "/v1/jobs", GetParam().body, kJson);
  EXPECT_EQ(answer.status, GetParam().status) << answer.body;
  EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
  const json problem = answer.json();
  ASSERT_TRUE(problem.contains("errors")) << answer.body;
  EXPECT_EQ(problem["errors"][0]["code"], GetParam().code) << answer.body;
  EXPECT_EQ(problem["errors"][0]["pointer"], GetParam().pointer) << answer.body;
  EXPECT_NO_THROW(validate_document("problem.schema.json", problem)) << answer.body;
  EXPECT_EQ(store_->queued_jobs(), 0);
}

std::string with_body(const std::string& body) {
  return R"({"scene":{"garments":[{"rectangle":{"width_mm":300,"height_mm":300}}],"body":)" + body + "}}";
}

const std::string kDeepest = [] {
  std::string pointer;
  for (int i = 0; i < 32; ++i) pointer += "/0";
  return pointer;
}();
const std::string kAbsent = "sha256:" + std::string(64, '0');

INSTANTIATE_TEST_SUITE_P(
    All, BadSceneTest,
    testing::Values(BadScene{"BrokenJson", R"({"scene": {"garments": [)", 400, "json_syntax", ""},
                    BadScene{"DeepJson", R"({"scene": )" + std::string(100'000, '[') + std::string(100'000, ']') + "}",
                             400, "json_too_deep", kDeepest.c_str()},
                    BadScene{"NaN", with_body(R"({"sphere":{"radius_mm":NaN}})"), 400, "json_syntax", ""},
                    BadScene{"HugeNumber", with_body(R"({"sphere":{"radius_mm":1e400}})"), 400,
                             "json_number_out_of_range", "/body/sphere/radius_mm"},
                    BadScene{"NoScene", R"({})", 422, "missing_key", ""},
                    BadScene{"NotAnObject", R"([1, 2])", 422, "missing_key", ""},
                    BadScene{"UnknownKeyBesideScene", R"({"scene":)" + scene_named("x") + R"(,"priority":1})", 422,
                             "unknown_key", ""},
                    BadScene{"NoGarment", R"({"scene":{"garments":[]}})", 422, "wrong_size", "/garments"},
                    BadScene{"FileOverHttp", with_body(R"({"mesh":{"file":"/etc/passwd"}})"), 422, "file_not_allowed",
                             "/body/mesh/file"},
                    BadScene{"AssetThatIsNotThere", with_body(R"({"mesh":{"asset":")" + kAbsent + R"("}})"), 422,
                             "asset_not_found", "/body/mesh/asset"}),
    [](const auto& made) { return std::string(made.param.name); });

TEST_F(ServiceTest, TakesJsonOnly) {
  const Answer answer =
      request("POST", "/v1/jobs", R"({"scene":{}})", {{"Content-Type", "application/x-www-form-urlencoded"}});
  EXPECT_EQ(answer.status, 415);
  EXPECT_THAT(answer.body, HasSubstr("--json"));
}

TEST_F(ServiceTest, ShowsFabricsAndSchemas) {
  const json fabrics = request("GET", "/v1/fabrics").json();
  ASSERT_FALSE(fabrics["fabrics"].empty());
  const std::string name = fabrics["fabrics"][0]["name"];
  EXPECT_EQ(request("GET", "/v1/fabrics/" + name).json(), fabrics["fabrics"][0]);
  EXPECT_NO_THROW(validate_document("fabric.schema.json", fabrics["fabrics"][0])) << fabrics["fabrics"][0];
  EXPECT_EQ(request("GET", "/openapi.json").json()["openapi"].get<std::string>().substr(0, 2), "3.");
  EXPECT_EQ(request("GET", "/v1/fabrics/unobtainium").status, 404);
  EXPECT_THAT(request("GET", "/v1/schemas").body, HasSubstr("\"scene.schema.json\""));
  const Answer schema = request("GET", "/v1/schemas/scene.schema.json");
  EXPECT_EQ(schema.status, 200);
  EXPECT_EQ(schema.json()["title"], "Scene");
  EXPECT_EQ(request("GET", "/v1/schemas/scene.schema.json", {}, {{"If-None-Match", schema.header("ETag")}}).status,
            304);
}

TEST_F(ServiceTest, HealthIsAskedOfTheStoreAndTheDispatcher) {
  const Answer answer = request("GET", "/healthz");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.json()["status"], "ok");
  EXPECT_EQ(answer.json()["queued"], 0);
}

/// A store whose disk is gone.
class FailingStore final : public Store {
 public:
  explicit FailingStore(Store& good) : good_(good) {}
  bool put_asset(const std::string&, std::string_view, TimeMs) override { fail(); }
  bool has_asset(const std::string&) override { fail(); }
  std::optional<std::string> asset(const std::string&) override { fail(); }
  Submission submit(const NewJob&, TimeMs) override { fail(); }
  std::optional<JobRecord> job(const std::string&) override { fail(); }
  JobPage jobs(std::optional<JobState>, const std::string&, int) override { fail(); }
  long queued_jobs() override { fail(); }
  std::optional<Lease> lease(TimeMs now, TimeMs duration) override { return good_.lease(now, duration); }
  LeaseState heartbeat(const Lease&, const std::string&, TimeMs, TimeMs) override { fail(); }
  bool publish(const Lease&, JobState, const std::string&, const std::vector<Artifact>&, TimeMs) override { fail(); }
  bool give_up(const Lease&, const std::string&, TimeMs, TimeMs) override { fail(); }
  bool hand_back(const Lease&, TimeMs) override { fail(); }
  long release_all_leases(TimeMs) override { fail(); }
  CancelOutcome cancel(const std::string&, TimeMs) override { fail(); }
  void add_artifact(const std::string&, const Artifact&) override { fail(); }
  std::optional<Artifact> artifact(const std::string&, const std::string&) override { fail(); }
  void check() override { fail(); }

 private:
  [[noreturn]] static void fail() { throw StoreError(StoreError::Kind::unavailable, "the disk /dev/secret is gone"); }
  Store& good_;
};

TEST_F(ServiceTest, AFailingStoreIsSaidWithoutItsInsides) {
  FailingStore failing(*store_);
  Service service{failing, *dispatcher_, *previews_, system_time_ms, {}};
  HttpServer server(make_router(service));
  const int healthy_port = std::exchange(port_, server.bind("127.0.0.1", 0));
  std::thread serving([&] { server.serve(); });
  for (const char* path : {"/healthz", "/v1/jobs"}) {
    const Answer answer = request("GET", path);
    EXPECT_EQ(answer.status, 503) << path;
    EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
    EXPECT_THAT(answer.head + answer.body, testing::Not(HasSubstr("secret"))) << path;
  }
  server.stop();
  serving.join();
  port_ = healthy_port;
}

TEST(JobDocument, WritesTimesAsRfc3339) {
  EXPECT_EQ(rfc3339(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(rfc3339(1'795'384'850'007), "2026-11-22T22:00:50.007Z");
}

}  // namespace
}  // namespace toile
