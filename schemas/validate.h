#pragma once
// Documents against the JSON Schemas of this folder.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace toile {

/// Checks a document against the embedded schema of that name ("scene.schema.json"). Throws InputError with one problem
/// a place: pointers begin with `pointer`, codes are unknown_key, missing_key, wrong_type, out_of_range, wrong_size,
/// not_allowed (not one of the values or not of the form listed) and not_exactly_one (of
/// several forms). At most 32 problems.
/// Thread-safe; schemas are compiled once.
void validate_document(std::string_view schema, const nlohmann::json& document, const std::string& pointer = "");

/// The schema with everything that it refers to in one document.
nlohmann::json bundled_schema(std::string_view schema);

}  // namespace toile
