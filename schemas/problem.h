#pragma once
// RFC 9457 problem documents (problem.schema.json).

#include "engine/scene/problem.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace toile {

/// The problem document of input that can't be simulated. Status 400 where it is not even JSON (codes json_…; 413 for
/// json_too_large), 422 otherwise. Text that is not UTF-8 is repaired, so that dump() can't throw.
nlohmann::json problem_document(const InputError& error);

/// File names, keys and groups' names may hold any bytes; what is not UTF-8 becomes U+FFFD.
std::string utf8(const std::string& text);

/// A problem that its status says: type about:blank, title the status's phrase.
nlohmann::json problem_document(int status, const std::string& detail);

}  // namespace toile
