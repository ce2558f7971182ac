#include "schemas/parse_json.h"
#include "schemas/resource.h"
#include "server/http/problem_response.h"
#include "server/http/service.h"
#include "tests/server/http/service_fixture.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

namespace toile {
namespace {

using nlohmann::json;
using OpenApiTest = ServiceFixture;

json paths() { return parse_json(resource("openapi.json"))["paths"]; }

/// "GET /v1/jobs/{}" for every operation.
std::set<std::string> documented() {
  std::set<std::string> operations;
  const json documented_paths = paths();
  for (const auto& [path, item] : documented_paths.items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method == "parameters") continue;
      std::string name = method;
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
      operations.insert(name + " " + std::regex_replace(path, std::regex(R"(\{\w+\})"), "{}"));
    }
  }
  return operations;
}

TEST_F(OpenApiTest, DocumentAndRouterKnowTheSamePathsAndMethods) {
  std::set<std::string> routed;
  const Router router = make_router(*service_);
  for (const Route& route : router.routes()) {
    std::string path = route.path;
    if (path.back() == '/') path.pop_back();  // the same thing for those who end it with a slash
    routed.insert(route.method + " " + path);
  }
  EXPECT_EQ(routed, documented());
}

TEST_F(OpenApiTest, TheRouterMatchesEveryDocumentedPath) {
  const Router router = make_router(*service_);
  for (const std::string& operation : documented()) {
    const std::size_t space = operation.find(' ');
    const std::string path = std::regex_replace(operation.substr(space + 1), std::regex(R"(\{\})"), "some-name");
    EXPECT_NO_THROW(router.match(operation.substr(0, space), path)) << operation;
  }
}

TEST_F(OpenApiTest, EveryOperationListsTheStatusesThatWereSeen) {
  const std::string id = submit("fine").json()["id"];
  wait_for_end(id);
  const auto expect_listed = [&](const std::string& method, const std::string& path, const std::string& of,
                                 const std::string& body, const char* header = "", const std::string& value = {}) {
    std::string lower = method;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    std::vector<std::pair<std::string, std::string>> headers;
    if (*header) headers.emplace_back(header, value);
    const int status = request(method, path, body, headers).status;
    EXPECT_TRUE(paths()[of][lower]["responses"].contains(std::to_string(status))) << method << path << ' ' << status;
    return status;
  };
  EXPECT_EQ(expect_listed("POST", "/v1/assets", "/v1/assets", ""), 422);
  EXPECT_EQ(expect_listed("POST", "/v1/assets", "/v1/assets", "v"), 201);
  EXPECT_EQ(expect_listed("POST", "/v1/assets", "/v1/assets", "v"), 200);
  EXPECT_EQ(expect_listed("POST", "/v1/jobs", "/v1/jobs", "{", "Content-Type", "application/json"), 400);
  EXPECT_EQ(expect_listed("POST", "/v1/jobs", "/v1/jobs", "{}", "Content-Type", "text/plain"), 415);
  EXPECT_EQ(expect_listed("GET", "/v1/jobs?limit=0", "/v1/jobs", ""), 400);
  EXPECT_EQ(expect_listed("GET", "/v1/jobs/none", "/v1/jobs/{id}", ""), 404);
  EXPECT_EQ(expect_listed("DELETE", "/v1/jobs/" + id, "/v1/jobs/{id}", ""), 409);
  for (const std::string result : {"report", "mesh.obj"}) {
    const std::string path = "/v1/jobs/" + id + "/" + result, of = "/v1/jobs/{id}/" + result;
    EXPECT_EQ(expect_listed("GET", path, of, "", "If-None-Match", "*"), 304);
  }
  for (const std::string path : {"/v1/fabrics", "/v1/schemas", "/openapi.json"}) {
    const std::string etag = request("GET", path).header("ETag");
    EXPECT_EQ(expect_listed("GET", path, path, "", "If-None-Match", etag), 304);
  }
  EXPECT_EQ(expect_listed("GET", "/v1/fabrics/poplin", "/v1/fabrics/{name}", ""), 200);
  EXPECT_EQ(expect_listed("GET", "/v1/fabrics/none", "/v1/fabrics/{name}", ""), 404);
  EXPECT_EQ(expect_listed("GET", "/v1/schemas/none", "/v1/schemas/{name}", ""), 404);
}

TEST_F(OpenApiTest, HealthIsAsDocumented) {
  const json schema = parse_json(resource("openapi.json"))["components"]["schemas"]["Health"];
  const json health = request("GET", "/healthz").json();
  std::set<std::string> keys, required;
  for (const auto& [key, value] : health.items()) keys.insert(key);
  for (const json& key : schema["required"]) required.insert(key);
  EXPECT_EQ(health.value("status", ""), "ok");
  EXPECT_EQ(keys, required);
}

TEST_F(OpenApiTest, PreviewDefaultsAreTheServers) {
  const std::string id = submit("fine").json()["id"];
  wait_for_end(id);
  const std::string path = "/v1/jobs/" + id + "/preview.png";
  const json parameters = paths()["/v1/jobs/{id}/preview.png"]["get"]["parameters"];
  std::string query = "?";
  for (const json& parameter : parameters)
    query += parameter["name"].get<std::string>() + "=" + parameter["schema"]["default"].get<std::string>() + "&";
  query.pop_back();
  const Answer plain = request("GET", path), said = request("GET", path + query);
  EXPECT_EQ(plain.status, 200) << plain.body;
  EXPECT_EQ(plain.header("ETag"), said.header("ETag"));
}

}  // namespace
}  // namespace toile
