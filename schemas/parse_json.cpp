#include "schemas/parse_json.h"

#include "engine/scene/problem.h"
#include "schemas/pointer.h"

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace toile {

namespace {

using nlohmann::json;

/// An array or object that is being parsed.
struct Level {
  bool is_object;
  std::size_t index = 0;       ///< of the array's element that is being parsed
  std::string key;             ///< of the object's member that is being parsed
  std::set<std::string> keys;  ///< seen so far
};

std::string pointer_to(const std::vector<Level>& levels) {
  std::string pointer;
  for (const Level& level : levels) {
    pointer = level.is_object ? child(std::move(pointer), level.key) : child(std::move(pointer), level.index);
  }
  return pointer;
}

void value_ended(std::vector<Level>& levels) {
  if (!levels.empty() && !levels.back().is_object) ++levels.back().index;
}

}  // namespace

json parse_json(std::string_view bytes, const JsonLimits& limits) {
  if (bytes.size() > limits.bytes) {
    throw InputError("", "json_too_large",
                     "The document has " + std::to_string(bytes.size()) + " bytes; at most " +
                         std::to_string(limits.bytes) + " are read.");
  }
  std::vector<Level> levels;
  const auto guard = [&](int, json::parse_event_t event, json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        if (static_cast<int>(levels.size()) >= limits.depth) {
          throw InputError(pointer_to(levels), "json_too_deep",
                           "Arrays and objects are nested deeper than " + std::to_string(limits.depth) + " levels.");
        }
        levels.push_back({event == json::parse_event_t::object_start, 0, {}, {}});
        break;
      case json::parse_event_t::key:
        levels.back().key = parsed.get_ref<const std::string&>();
        if (!levels.back().keys.insert(levels.back().key).second) {
          throw InputError(pointer_to(levels), "json_duplicate_key",
                           "The key \"" + levels.back().key + "\" appears twice in one object.");
        }
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        levels.pop_back();
        value_ended(levels);
        break;
      case json::parse_event_t::value:
        value_ended(levels);
        break;
    }
    return true;
  };
  try {
    return json::parse(bytes, guard);
  } catch (const json::parse_error& error) {
    throw InputError("", "json_syntax", "Not JSON at byte " + std::to_string(error.byte) + ".");
  } catch (const json::out_of_range&) {
    throw InputError(pointer_to(levels), "json_number_out_of_range", "A number here does not fit into a double.");
  }
}

}  // namespace toile
