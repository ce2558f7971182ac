// What the HTTP library lets through, refused: each case is a row of what was measured of it.

#include "tests/server/http/service_fixture.h"

#include <gmock/gmock.h>

#include <fstream>

namespace toile {
namespace {

using testing::HasSubstr;
using Guards = ServiceFixture;

/// A sanitizer's own records count as resident, several times what they are of.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr bool kMemoryTells = false;
#else
constexpr bool kMemoryTells = true;
#endif

long resident_kib() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word == "VmRSS:") {
      long kib = 0;
      status >> kib;
      return kib;
    }
  }
  return 0;
}

std::string code_of(const Answer& answer) {
  const nlohmann::json document = answer.json();
  return document.contains("errors") ? document["errors"][0].value("code", "") : "";
}

TEST_F(Guards, AChunkedBodyIsRefused) {
  const Answer answer =
      raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
          "5\r\nhello\r\n0\r\n\r\n");
  EXPECT_EQ(answer.status, 411);
  EXPECT_EQ(code_of(answer), "length_required");
  EXPECT_EQ(answer.header("Connection"), "close");
  EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
}

TEST_F(Guards, ChunkedTogetherWithALengthIsRefused) {
  EXPECT_EQ(
      raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\nhello").status,
      411);
}

TEST_F(Guards, ACompressedBodyIsRefused) {
  EXPECT_EQ(request("POST", "/v1/assets", "\x1f\x8b", {{"Content-Encoding", "gzip"}}).status, 415);
}

TEST_F(Guards, ABodyWithoutLengthIsRefused) {
  EXPECT_EQ(raw("POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n\r\n{}").status, 411);
}

TEST_F(Guards, TwoLengthsAreRefused) {
  EXPECT_EQ(raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\nContent-Length: 3\r\n\r\nab").status, 400);
}

TEST_F(Guards, ALengthThatIsNoNumberIsRefused) {
  for (const char* length : {"-1", "0x10", "1e9", "5,5"}) {
    EXPECT_EQ(
        raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::string(length) + "\r\n\r\nab").status, 400)
        << length;
  }
}

TEST_F(Guards, AHugeBodyIsRefusedByItsLengthBeforeAByteIsRead) {
  const long before = resident_kib();
  for (const char* length : {"104857600", "99999999999999999999999"}) {
    const Answer answer =
        raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::string(length) + "\r\n\r\n");
    EXPECT_EQ(answer.status, 413) << length;
    EXPECT_THAT(answer.body, HasSubstr("67108864"));
  }
  if (kMemoryTells) {
    EXPECT_LT(resident_kib() - before, 32 * 1024);
  }
}

TEST_F(Guards, ExpectContinueIsAnsweredByTheRefusal) {
  const Answer answer =
      raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: 104857600\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(answer.status, 413);
}

TEST_F(Guards, ABodyCutShortIsNoAsset) {
  const Answer answer = raw("POST /v1/assets HTTP/1.1\r\nHost: x\r\nContent-Length: 500\r\n\r\nonly this");
  EXPECT_NE(answer.status, 201);
  EXPECT_NE(answer.status, 200);
}

TEST_F(Guards, AGetWithABodyIsRefused) {
  EXPECT_EQ(raw("GET /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nConnection: close\r\n\r\nhello").status, 413);
}

TEST_F(Guards, AMultipartBodyIsRefused) {
  const Answer answer =
      request("POST", "/v1/assets", "--x\r\n\r\nv\r\n--x--", {{"Content-Type", "multipart/form-data; boundary=x"}});
  EXPECT_EQ(answer.status, 415);
  EXPECT_THAT(answer.body, HasSubstr("--data-binary"));
}

TEST_F(Guards, RangesAreIgnored) {
  const std::string whole = request("GET", "/v1/fabrics").body;
  ASSERT_GT(whole.size(), 100U);
  for (const char* range : {"bytes=0-9", "bytes=99999999-", "bytes=0-1,0-1,0-1,0-1"}) {
    const Answer answer = request("GET", "/v1/fabrics", {}, {{"Range", range}});
    EXPECT_EQ(answer.status, 200) << range;
    EXPECT_EQ(answer.body, whole) << range;
  }
}

TEST_F(Guards, UnknownMethodsGetAllow) {
  const Answer answer = request("PUT", "/v1/jobs");
  EXPECT_EQ(answer.status, 405);
  EXPECT_EQ(answer.header("Allow"), "GET, HEAD, POST");
  EXPECT_EQ(code_of(answer), "method_not_allowed");
  EXPECT_EQ(request("DELETE", "/v1/fabrics").status, 405);
  EXPECT_EQ(request("OPTIONS", "/v1/jobs").status, 405);
}

TEST_F(Guards, UnknownPathsAreNotFound) {
  for (const char* path : {"/", "/v1", "/v1/jobs/", "/v1/jobs/x/y", "/v1//jobs", "/../etc/passwd",
                           "/v1/schemas/..%2f..%2fetc%2fpasswd", "/v1/schemas/fabrics/poplin.json"}) {
    EXPECT_EQ(request("GET", path).status, 404) << path;
  }
}

TEST_F(Guards, LongPathsAndManyHeadersAreRefused) {
  EXPECT_EQ(request("GET", "/" + std::string(5000, 'a')).status, 414);
  std::string head = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n";
  for (int i = 0; i < 200; ++i) head += "X-" + std::to_string(i) + ": y\r\n";
  EXPECT_EQ(raw(head + "\r\n").status, 431);
}

TEST_F(Guards, RubbishGetsAProblemAndTheServerStaysUp) {
  const Answer answer = raw("\x16\x03\x01 this is no HTTP\r\n\r\n");
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(request("GET", "/healthz").status, 200);
}

TEST_F(Guards, ManyConnectionsAtOnceAreServed) {
  std::vector<std::thread> clients;
  std::atomic<int> served{0};
  for (int i = 0; i < 40; ++i) {
    clients.emplace_back([&] {
      for (int k = 0; k < 5; ++k) served += request("GET", "/v1/jobs").status == 200 ? 1 : 0;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(served, 200);
}

}  // namespace
}  // namespace toile
