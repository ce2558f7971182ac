// GCC 12 takes string concatenations inlined from valijson for overlapping copies (GCC bug 105651).
#pragma GCC diagnostic ignored "-Wrestrict"

#include "schemas/validate.h"

#include "engine/scene/problem.h"
#include "schemas/pointer.h"
#include "schemas/resource.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace toile {

namespace {

using nlohmann::json;

constexpr std::size_t kMostProblems = 32;

json load(std::string_view name) {
  const std::string_view bytes = resource(name);
  if (bytes.empty()) throw std::logic_error("no schema " + std::string(name));
  return json::parse(bytes);
}

/// Turns references to other files into references to `definitions` of the one document. (valijson's cache mixes up
/// equal paths of different files.)
void bundle(json& node, const std::string& file, json& root) {
  if (node.is_array()) {
    for (json& item : node) bundle(item, file, root);
  } else if (node.is_object()) {
    if (const auto reference = node.find("$ref"); reference != node.end() && reference->is_string()) {
      const std::string target = reference->get<std::string>();
      const std::size_t hash = target.find('#');
      const std::string other = target.substr(0, hash);
      const std::string inner = hash == std::string::npos ? "" : target.substr(hash + 1);
      const std::string& home = other.empty() ? file : other;
      *reference = std::string(home.empty() ? "#" : "#/definitions/").append(home).append(inner);
      if (!other.empty() && !root["definitions"].contains(other)) {
        root["definitions"][other] = nullptr;
        json document = load(other);
        bundle(document, other, root);
        root["definitions"][other] = std::move(document);
      }
      return;
    }
    for (auto& [key, value] : node.items()) bundle(value, file, root);
  }
}

const valijson::Schema& compiled(std::string_view name) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<valijson::Schema>, std::less<>> schemas;
  const std::lock_guard lock(mutex);
  if (const auto found = schemas.find(name); found != schemas.end()) return *found->second;
  const json document = bundled_schema(name);
  auto schema = std::make_unique<valijson::Schema>();
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(document), *schema);
  return *schemas.emplace(name, std::move(schema)).first->second;
}

struct Place {
  std::string pointer;
  const json* value;
};

/// valijson's path, "<root>", "[key]", "[3]", …, as a pointer and as the value there.
Place locate(const std::vector<std::string>& context, const json& document, const std::string& prefix) {
  Place place{prefix, &document};
  for (std::size_t i = 1; i < context.size(); ++i) {
    const std::string step = context[i].substr(1, context[i].size() - 2);
    place.pointer = child(std::move(place.pointer), step);
    if (place.value->is_object() && place.value->contains(step)) {
      place.value = &(*place.value)[step];
    } else if (place.value->is_array()) {
      place.value = &(*place.value)[std::stoul(step)];
    }
  }
  return place;
}

/// The name that stands in quotes after `before` at the end of a message.
std::string name_after(const std::string& text, std::string_view before) {
  const std::size_t start = text.find(before) + before.size(), end = text.rfind('\'');
  return text.substr(start, end - start);
}

bool starts_with(const std::string& text, std::string_view start) { return text.compare(0, start.size(), start) == 0; }

/// Whether an error only says that something below it, reported by itself, is wrong.
bool is_echo(const std::string& text) {
  for (const char* echo :
       {"Failed to validate against child schema", "Failed to validate against any", "Failed to validate item",
        "Failed to validate against additional", "Failed to validate against schema associated"}) {
    if (starts_with(text, echo)) return true;
  }
  return false;
}

/// The document with long lists cut: an error costs memory, and a hostile list has millions.
json cut(const json& value, std::size_t most) {
  if (value.is_array()) {
    json items = json::array();
    for (std::size_t i = 0; i < std::min(value.size(), most); ++i) items.push_back(cut(value[i], most));
    return items;
  }
  if (value.is_object()) {
    json members = json::object();
    for (const auto& [key, member] : value.items()) {
      if (members.size() < std::max<std::size_t>(most, 256)) members[key] = cut(member, most);
    }
    return members;
  }
  return value;
}

/// The errors within the shortest beginnings of the lists that have any.
valijson::ValidationResults errors_of(const valijson::Schema& schema, const json& document) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  for (const std::size_t most : {32u, 256u, 2048u, 16384u}) {
    if (!validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(cut(document, most)), &results)) break;
  }
  return results;
}

std::string keys_of(const json& value) {
  std::string keys;
  for (const auto& [key, unused] : value.items()) keys.append(keys.empty() ? "" : ", ").append(key);
  return keys.empty() ? "none" : keys;
}

Problem translate(const std::string& text, Place place) {
  if (starts_with(text, "Object contains a property")) {
    const std::string key = name_after(text, "constraints: '");
    return {child(std::move(place.pointer), key), "unknown_key", "The key \"" + key + "\" is not known here."};
  }
  if (starts_with(text, "Missing required property")) {
    const std::string key = name_after(text, "property '");
    return {std::move(place.pointer), "missing_key", "The key \"" + key + "\" is missing."};
  }
  if (text.find("'type' constraint") != std::string::npos) {
    return {std::move(place.pointer), "wrong_type",
            std::string("A value of type ") + place.value->type_name() + " is not allowed here."};
  }
  if (starts_with(text, "Expected number")) {
    const json& number = *place.value;
    // valijson prints bounds with six decimals.
    const bool tiny = text.find("equal to 0.000000") != std::string::npos;
    return {
        std::move(place.pointer), "out_of_range",
        (tiny ? "Expected a number not under the least one allowed here" : text) + "; it is " + number.dump() + "."};
  }
  if (starts_with(text, "Array should") || starts_with(text, "String should") || starts_with(text, "Object should")) {
    return {std::move(place.pointer), "wrong_size", text};
  }
  if (text.find("enum") != std::string::npos || text.find("regex") != std::string::npos) {
    return {std::move(place.pointer), "not_allowed",
            "This value is not one of those allowed here; GET /v1/schemas/ lists them."};
  }
  return {std::move(place.pointer), "not_valid", text};
}

}  // namespace

json bundled_schema(std::string_view name) {
  json root = load(name);
  json definitions = root;
  bundle(definitions, "", root);
  json others = root.value("definitions", json::object());
  for (auto& [key, value] : others.items()) {
    if (!definitions["definitions"].contains(key)) definitions["definitions"][key] = value;
  }
  return definitions;
}

void validate_document(std::string_view schema, const json& document, const std::string& pointer) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  if (validator.validate(compiled(schema), valijson::adapters::NlohmannJsonAdapter(document), nullptr)) return;
  valijson::ValidationResults results = errors_of(compiled(schema), document);

  std::vector<Problem> problems;
  const auto add = [&](Problem problem) {
    const auto same = [&](const Problem& p) { return p.pointer == problem.pointer && p.code == problem.code; };
    if (problems.size() < kMostProblems && std::none_of(problems.begin(), problems.end(), same)) {
      problems.push_back(std::move(problem));
    }
  };
  std::vector<Problem> alternatives;  // what each form of a oneOf misses: said once, at the object
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    Place place = locate(error.context, document, pointer);
    if (error.description.find("oneOf") != std::string::npos ||
        error.description.find("exactly one child") != std::string::npos) {
      const std::string found = place.value->is_object() ? keys_of(*place.value) : place.value->type_name();
      add({std::move(place.pointer), "not_exactly_one",
           "Exactly one of the forms that the schema lists is needed here; found: " + found + "."});
    } else if (!is_echo(error.description)) {
      add(translate(error.description, std::move(place)));
    }
  }
  if (problems.empty()) {
    problems.push_back(
        {pointer, "not_valid", "A list is too long, or an element far down in it does not match its schema."});
  }
  const auto said = [&, first = problems](const std::string& code, const std::string& place) {
    return std::any_of(first.begin(), first.end(),
                       [&](const Problem& p) { return p.code == code && p.pointer == place; });
  };
  // One finding a place: what each form of a choice misses, and what a value of the wrong type is not, go without
  // saying.
  std::erase_if(problems, [&](const Problem& p) {
    return (p.code == "missing_key" && said("not_exactly_one", p.pointer)) ||
           (p.code != "wrong_type" && said("wrong_type", p.pointer));
  });
  throw InputError(std::move(problems));
}

}  // namespace toile
