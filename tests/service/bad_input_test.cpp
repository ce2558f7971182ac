// Every document of schemas/examples/invalid by curl: refused with its place or, where only a run can tell, a failed
// job; the server stays up and small.

#include "tests/service/service_process.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace toile {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr long kSmallKib = 150 * 1024;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class BadInputOverCurl : public testing::Test {
 protected:
  /// Sends {"scene": <bytes>}.
  CurlAnswer send(const ServiceProcess& server, const std::string& scene) const {
    std::ofstream(folder_ / "body", std::ios::binary) << "{\"scene\":" << scene << "}";
    return server.curl("/v1/jobs", "-H 'Content-Type: application/json' --data-binary @" + folder_ / "body");
  }

  const TemporaryFolder folder_;
};

TEST_F(BadInputOverCurl, EachExampleIsRefusedWithItsPlace) {
  const ServiceProcess server(folder_ / "data");
  int refused = 0, failed = 0;
  for (const auto& entry : fs::directory_iterator(TOILE_SOURCE "/schemas/examples/invalid")) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".problem.json") || !name.ends_with(".json")) continue;
    SCOPED_TRACE(name);
    const CurlAnswer answer = send(server, content_of(entry.path()));
    json problem = answer.json();
    if (answer.status == 202) {
      const json job = server.wait_for(problem["id"], "failed");
      ASSERT_EQ(job["state"], "failed") << job;
      EXPECT_EQ(job["attempts"], 1) << "bad input is not tried again";
      problem = job["error"];
      ++failed;
    } else {
      EXPECT_GE(answer.status, 400);
      EXPECT_LT(answer.status, 500);
      ++refused;
    }
    ASSERT_TRUE(problem.is_object() && problem.contains("errors")) << answer.body;
    EXPECT_TRUE(problem["errors"][0].contains("pointer")) << problem;
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(failed, 0);
  EXPECT_EQ(server.curl("/healthz").status, 200);
  EXPECT_LT(server.resident_kib(), kSmallKib);
}

TEST_F(BadInputOverCurl, AHundredMegabytesAreRefused) {
  const ServiceProcess server(folder_ / "data");
  const std::string file = folder_ / "large";
  std::ofstream(file).close();
  fs::resize_file(file, 100'000'000);
  EXPECT_EQ(server.curl("/v1/assets", "--data-binary @" + file).status, 413);
  EXPECT_EQ(server.curl("/v1/assets", "-H 'Expect:' --data-binary @" + file).status, 413);
  EXPECT_EQ(server.curl("/v1/jobs", "-H 'Content-Type: application/json' --data-binary @" + file).status, 413);
  EXPECT_EQ(server.curl("/v1/assets", "-H 'Transfer-Encoding: chunked' --data-binary @" + file).status, 411);
  EXPECT_EQ(server.curl("/healthz").status, 200);
  EXPECT_LT(server.resident_kib(), kSmallKib);
}

TEST_F(BadInputOverCurl, ScenesWithFilesAreRefused) {
  const ServiceProcess server(folder_ / "data");
  const CurlAnswer answer = send(server, R"({"garments":[{"pattern":{"file":"/etc/passwd"}}]})");
  EXPECT_EQ(answer.status, 422);
  EXPECT_EQ(answer.json()["errors"][0]["pointer"], "/garments/0/pattern/file") << answer.body;
}

}  // namespace
}  // namespace toile
