#include "schemas/parse_json.h"

#include "engine/scene/problem.h"
#include "schemas/pointer.h"

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <vector>

namespace toile {

namespace {

using nlohmann::json;

/// Looks through a document before it is built, since building can't be stopped where it goes wrong but with a callback
/// whose cost grows with the square of an object's members.
class Guard final : public nlohmann::json_sax<json> {
 public:
  explicit Guard(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return start(true); }
  bool start_array(std::size_t) override { return start(false); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }
  bool key(string_t& key) override {
    Level& level = levels_.back();
    level.key = key;
    if (level.keys.insert(key).second) return true;
    throw InputError(pointer(), "json_duplicate_key", "The key \"" + key + "\" appears twice in one object.");
  }
  bool parse_error(std::size_t byte, const std::string&, const json::exception& error) override {
    if (dynamic_cast<const json::out_of_range*>(&error))
      throw InputError(pointer(), "json_number_out_of_range", "A number here does not fit into a double.");
    throw InputError("", "json_syntax", "Not JSON at byte " + std::to_string(byte) + ".");
  }

 private:
  /// An array or object that is being read.
  struct Level {
    bool is_object;
    std::size_t index = 0;                 ///< of the array's element that is being read
    std::string key;                       ///< of the object's member that is being read
    std::unordered_set<std::string> keys;  ///< seen so far
  };

  std::string pointer() const {
    std::string text;
    for (const Level& level : levels_)
      text = level.is_object ? child(std::move(text), level.key) : child(std::move(text), level.index);
    return text;
  }
  bool value() {
    if (++values_ > limits_.values)
      throw InputError("", "json_too_large",
                       "The document has more than " + std::to_string(limits_.values) + " values.");
    if (!levels_.empty() && !levels_.back().is_object) ++levels_.back().index;
    return true;
  }
  bool start(bool is_object) {
    if (static_cast<int>(levels_.size()) >= limits_.depth)
      throw InputError(pointer(), "json_too_deep",
                       "Arrays and objects are nested deeper than " + std::to_string(limits_.depth) + " levels.");
    levels_.push_back({is_object, 0, {}, {}});
    return true;
  }
  bool end() {
    levels_.pop_back();
    return value();
  }

  JsonLimits limits_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
};

}  // namespace

json parse_json(std::string_view bytes, const JsonLimits& limits) {
  if (bytes.size() > limits.bytes) {
    throw InputError("", "json_too_large",
                     "The document has " + std::to_string(bytes.size()) + " bytes; at most " +
                         std::to_string(limits.bytes) + " are read.");
  }
  if (const std::size_t nul = bytes.find('\0'); nul != std::string_view::npos)  // the parser takes it for the end
    throw InputError("", "json_syntax", "Not JSON at byte " + std::to_string(nul + 1) + ".");
  Guard guard(limits);
  json::sax_parse(bytes, &guard);
  return json::parse(bytes);
}

}  // namespace toile
