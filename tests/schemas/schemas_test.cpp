#include "engine/scene/problem.h"
#include "schemas/parse_json.h"
#include "schemas/read_scene.h"
#include "schemas/resource.h"
#include "schemas/validate.h"
#include "tests/schemas/files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>

namespace toile {
namespace {

using nlohmann::json;

std::vector<std::string> schema_names() {
  std::vector<std::string> names;
  for (const std::string_view name : resource_names()) {
    if (name.find(".schema.json") != std::string_view::npos) names.emplace_back(name);
  }
  return names;
}

/// Calls visit(schema, place) for a schema and all schemas in it.
template <typename Visit>
void for_each_subschema(const json& schema, const std::string& place, Visit visit) {
  visit(schema, place);
  for (const char* map : {"properties", "definitions"}) {
    if (!schema.contains(map)) continue;
    for (const auto& [key, inner] : schema[map].items()) {
      for_each_subschema(inner, place + "/" + map + "/" + key, visit);
    }
  }
  for (const char* list : {"allOf", "oneOf"}) {
    if (!schema.contains(list)) continue;
    for (const json& inner : schema[list]) for_each_subschema(inner, place + "/" + list, visit);
  }
  for (const char* one : {"items", "additionalProperties"}) {
    if (schema.contains(one) && schema[one].is_object()) {
      for_each_subschema(schema[one], place + "/" + std::string(one), visit);
    }
  }
}

class Schemas : public ::testing::TestWithParam<std::string> {
 protected:
  json schema_ = parse_json(resource(GetParam()));
};

TEST_P(Schemas, UseOnlyKeywordsThatAreChecked) {
  const std::set<std::string> checked{"type",
                                      "properties",
                                      "additionalProperties",
                                      "required",
                                      "items",
                                      "minItems",
                                      "maxItems",
                                      "enum",
                                      "minimum",
                                      "maximum",
                                      "pattern",
                                      "exclusiveMinimum",
                                      "minLength",
                                      "maxLength",
                                      "minProperties",
                                      "exclusiveMaximum",
                                      "allOf",
                                      "oneOf",
                                      "maxProperties",
                                      "$ref",
                                      "definitions",
                                      "$schema",
                                      "$id",
                                      "title",
                                      "description",
                                      "default"};
  for_each_subschema(schema_, "", [&](const json& schema, const std::string& place) {
    ASSERT_TRUE(schema.is_object()) << place;
    for (const auto& [key, value] : schema.items()) EXPECT_TRUE(checked.contains(key)) << place << "/" << key;
    if (schema.contains("$ref")) {
      EXPECT_EQ(schema.size(), 1u) << place << ": siblings of $ref are ignored";
    }
    if (schema.contains("items")) {
      EXPECT_TRUE(schema["items"].is_object()) << place << ": one schema for all items";
    }
  });
}

/// All but someone else's format, which is read leniently.
std::vector<std::string> own_schema_names() {
  std::vector<std::string> names = schema_names();
  std::erase(names, "pattern.schema.json");
  return names;
}

class OwnSchemas : public Schemas {};

TEST_P(OwnSchemas, RefuseUnknownKeysAndLimitLists) {
  for_each_subschema(schema_, "", [&](const json& schema, const std::string& place) {
    if (schema.contains("properties") && place != "/definitions/garment/properties/pattern") {
      EXPECT_EQ(schema.value("additionalProperties", json()), json(false)) << place;
    }
  });
}

TEST_P(Schemas, EveryKeyHasASentence) {
  const auto described = [](const json& property) {
    return property.contains("description") || property.contains("$ref");
  };
  for_each_subschema(schema_, "", [&](const json& schema, const std::string& place) {
    if (!schema.contains("properties")) return;
    for (const auto& [key, property] : schema["properties"].items()) {
      EXPECT_TRUE(described(property)) << place << "/" << key;
    }
  });
}

TEST_P(Schemas, DefaultsMatchThemselves) {
  const json bundled = bundled_schema(GetParam());
  for_each_subschema(schema_, "", [&](const json& schema, const std::string& place) {
    if (!schema.contains("default")) return;
    const json& value = schema["default"];
    if (value.is_number() && schema.contains("minimum")) {
      EXPECT_GE(value, schema["minimum"]) << place;
    }
    if (value.is_number() && schema.contains("maximum")) {
      EXPECT_LE(value, schema["maximum"]) << place;
    }
    if (value.is_string() && schema.contains("enum")) {
      EXPECT_THAT(schema["enum"].get<std::vector<std::string>>(), ::testing::Contains(value.get<std::string>()));
    }
  });
}

TEST_P(Schemas, CanBeCompiled) {
  try {
    validate_document(GetParam(), json::object());
  } catch (const InputError&) {
  }
}

constexpr auto kBareName = [](const auto& schema) {
  const std::string name = schema.param;
  return name.substr(0, name.find('.'));
};
INSTANTIATE_TEST_SUITE_P(All, Schemas, ::testing::ValuesIn(schema_names()), kBareName);
INSTANTIATE_TEST_SUITE_P(All, OwnSchemas, ::testing::ValuesIn(own_schema_names()), kBareName);

/// Values that no key may take the process down with.
std::vector<json> hostile_values() {
  return {nullptr,
          true,
          -1,
          0,
          1e308,
          -1e308,
          5e-324,
          1.5,
          std::numeric_limits<std::uint64_t>::max(),
          std::numeric_limits<std::int64_t>::min(),
          "",
          std::string(100000, 'a'),
          "\u0000\u202e/~",
          json::array(),
          json::array({json::array({json::array()})}),
          json::array({1, "a", nullptr}),
          json(std::vector<int>(1000, 7)),
          json::object(),
          {{"unknown", 1}},
          {{"file", "../../etc/passwd"}},
          {{"asset", "sha256:"}}};
}

std::string refuse_all(const json&, const std::string& pointer) {
  throw InputError(pointer, "file_not_found", "no files here");
}

class Mutations : public ::testing::TestWithParam<const char*> {};

TEST_P(Mutations, AreReadOrRefusedAtTheirPlace) {
  const json scene = testing::json_from(std::string(TOILE_SOURCE "/schemas/examples/valid/") + GetParam());
  const json leaves = scene.flatten();
  std::set<std::string> pointers;  // of every value, the inner ones too
  for (const auto& [pointer, leaf] : leaves.items()) {
    for (std::size_t end = pointer.find('/', 1);; end = pointer.find('/', end + 1)) {
      pointers.insert(pointer.substr(0, end));
      if (end == std::string::npos) break;
    }
  }
  std::size_t refused = 0, tried = 0;
  for (const std::string& pointer : pointers) {
    for (const json& value : hostile_values()) {
      json changed = scene;
      changed[json::json_pointer(pointer)] = value;
      ++tried;
      try {
        read_scene(changed, refuse_all);
      } catch (const InputError& error) {
        ++refused;
        EXPECT_FALSE(error.problems().empty());
        EXPECT_LE(error.problems().size(), 64u);
      }
    }
  }
  EXPECT_GT(refused, tried / 2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Mutations,
                         ::testing::Values("every_default_said.json", "inline_pattern.json", "twisted_towel.json",
                                           "two_on_a_capsule.json", "inline_mesh.json"),
                         [](const auto& file) {
                           const std::string name = file.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(ValidateDocument, ReportsSeveralPlacesAtOnce) {
  const auto problems = testing::problems_of([] {
    validate_scene_document(parse_json(R"({"garments": [{"disc": {"radius_mm": -1}, "x": 0}], "fidelity": 3})"));
  });
  EXPECT_EQ(problems.size(), 3u);
}

TEST(ValidateDocument, StaysSmallOnMillionsOfWrongElements) {
  json scene = {{"garments", {{{"disc", {{"radius_mm", 1}}}, {"pins", {{{"vertices", json::array()}}}}}}}};
  scene["garments"][0]["pins"][0]["vertices"] = json(std::vector<std::string>(1000000, "x"));
  const auto problems = testing::problems_of([&] { validate_scene_document(scene); });
  ASSERT_FALSE(problems.empty());
  EXPECT_LE(problems.size(), 32u);
  scene["garments"][0]["pins"][0]["vertices"] = json(std::vector<int>(1000000, 1));
  EXPECT_EQ(testing::problems_of([&] { validate_scene_document(scene); }).size(), 1u);
}

}  // namespace
}  // namespace toile
