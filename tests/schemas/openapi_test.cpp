#include "schemas/parse_json.h"
#include "schemas/resource.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>

namespace toile {
namespace {

using nlohmann::json;

template <typename Visit>
void for_each_reference(const json& node, Visit visit) {
  if (node.is_object() && node.contains("$ref")) visit(node["$ref"].get<std::string>());
  if (!node.is_structured()) return;
  for (const json& inner : node) for_each_reference(inner, visit);
}

TEST(OpenApi, HasAllRoutes) {
  const json paths = parse_json(resource("openapi.json"))["paths"];
  std::set<std::string> routes;
  for (const auto& [path, operations] : paths.items()) {
    for (const char* method : {"get", "post", "delete"}) {
      if (operations.contains(method)) routes.insert(std::string(method) + " " + path);
    }
  }
  EXPECT_EQ(routes, (std::set<std::string>{"delete /v1/jobs/{id}", "get /healthz", "get /openapi.json",
                                           "get /v1/fabrics", "get /v1/jobs", "get /v1/jobs/{id}",
                                           "get /v1/jobs/{id}/mesh.glb", "get /v1/jobs/{id}/mesh.obj",
                                           "get /v1/jobs/{id}/preview.png", "get /v1/jobs/{id}/report",
                                           "get /v1/schemas/{name}", "post /v1/assets", "post /v1/jobs"}));
}

TEST(OpenApi, AllReferencesResolve) {
  const json document = parse_json(resource("openapi.json"));
  const std::string schemas = "/v1/schemas/";
  for_each_reference(document, [&](const std::string& reference) {
    if (reference.rfind(schemas, 0) == 0) {
      EXPECT_FALSE(resource(reference.substr(schemas.size())).empty()) << reference;
    } else {
      EXPECT_TRUE(document.contains(json::json_pointer(reference.substr(1)))) << reference;
    }
  });
}

TEST(OpenApi, ViewsAndOverlaysAreThoseOfTheScene) {
  const json render = parse_json(resource("scene.schema.json"))["definitions"]["render"]["properties"];
  const json parameters =
      parse_json(resource("openapi.json"))["paths"]["/v1/jobs/{id}/preview.png"]["get"]["parameters"];
  EXPECT_EQ(parameters[0]["schema"]["enum"], render["views"]["items"]["enum"]);
  EXPECT_EQ(parameters[1]["schema"]["enum"], render["overlays"]["items"]["enum"]);
}

}  // namespace
}  // namespace toile
