#include "schemas/fabrics.h"
#include "schemas/resource.h"
#include "server/http/problem_response.h"
#include "server/http/service.h"
#include "server/store/digest.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

/// Part of the program: changes only with it, so a client may keep it but should ask.
HttpResponse document(const HttpRequest& request, std::string body, const std::string& content_type) {
  HttpResponse response;
  const std::string digest = sha256_hex(body), etag = "\"" + digest + "\"";
  response.headers = {{"ETag", etag}, {"Cache-Control", "no-cache"}};
  if (request.header("if-none-match") == etag) {
    response.status = 304;
    return response;
  }
  response.content_type = content_type;
  response.body = std::move(body);
  return response;
}

HttpResponse fabrics(const HttpRequest& request) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& name : fabric_names()) {
    nlohmann::json entry = fabric_document(name).value();
    entry["name"] = name;
    list.push_back(std::move(entry));
  }
  return document(request, nlohmann::json{{"fabrics", std::move(list)}}.dump() + "\n", "application/json");
}

HttpResponse fabric(const HttpRequest& request) {
  const std::optional<nlohmann::json> found = fabric_document(request.captures[0]);
  if (!found) throw HttpProblem(404, "no_such_fabric", "There is no fabric of this name; GET /v1/fabrics lists them.");
  nlohmann::json entry = *found;
  entry["name"] = request.captures[0];
  return document(request, entry.dump() + "\n", "application/json");
}

bool is_schema_name(std::string_view name) {
  constexpr std::string_view kEnd = ".schema.json";
  return name.size() > kEnd.size() && name.substr(name.size() - kEnd.size()) == kEnd;
}

HttpResponse schemas(const HttpRequest& request) {
  nlohmann::json names = nlohmann::json::array();
  for (const std::string_view name : resource_names()) {
    if (is_schema_name(name)) names.push_back(name);
  }
  return document(request, nlohmann::json{{"schemas", std::move(names)}}.dump() + "\n", "application/json");
}

HttpResponse schema(const HttpRequest& request) {
  const std::string& name = request.captures[0];
  const std::string_view bytes = is_schema_name(name) ? resource(name) : std::string_view{};
  if (bytes.empty())
    throw HttpProblem(404, "no_such_schema", "There is no schema of this name; GET /v1/schemas lists them.");
  return document(request, std::string(bytes), "application/schema+json");
}

HttpResponse openapi(const HttpRequest& request) {
  return document(request, std::string(resource("openapi.json")), "application/json");
}

}  // namespace

void add_library_routes(Router& router) {
  router.add({"GET", "/v1/fabrics", fabrics, {}});
  router.add({"GET", "/v1/fabrics/{}", fabric, {}});
  router.add({"GET", "/v1/schemas", schemas, {}});
  router.add({"GET", "/v1/schemas/", schemas, {}});
  router.add({"GET", "/v1/schemas/{}", schema, {}});
  router.add({"GET", "/openapi.json", openapi, {}});
}

}  // namespace toile
