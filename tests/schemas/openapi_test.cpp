#include "schemas/parse_json.h"
#include "schemas/resource.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;

template <typename Visit>
void for_each_reference(const json& node, Visit visit) {
  if (node.is_object() && node.contains("$ref")) visit(node["$ref"].get<std::string>());
  if (!node.is_structured()) return;
  for (const json& inner : node) for_each_reference(inner, visit);
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
