#pragma once
// Bytes from outside into a JSON document, guarded against what a parser lets through or a later step dies of.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace toile {

struct JsonLimits {
  std::size_t bytes = 64u << 20;
  std::size_t values = 1000000;  ///< numbers, strings, arrays, …: each costs memory whatever its bytes
  int depth = 32;                ///< of nested arrays and objects; copies and dumps recurse
};

/// Parses one JSON document. Takes time in proportion to its bytes. Throws InputError with the codes json_too_large,
/// json_syntax (with the byte's place; also NaN, invalid UTF-8 and NUL), json_too_deep, json_duplicate_key,
/// json_number_out_of_range (1e400).
nlohmann::json parse_json(std::string_view bytes, const JsonLimits& limits = {});

}  // namespace toile
