#pragma once
// Files and expected failures for the tests of schemas/.

#include "engine/scene/pattern.h"
#include "engine/scene/problem.h"

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace toile::testing {

/// The bytes of a file; fails the test where it can't be read.
std::string bytes_of(const std::filesystem::path& path);

/// The document in a file, through parse_json.
nlohmann::json json_from(const std::filesystem::path& path);

/// The pattern in a file, through read_pattern.
Pattern pattern_from(const std::filesystem::path& path);

/// The problems of the InputError that `action` throws; none where it throws nothing.
std::vector<Problem> problems_of(const std::function<void()>& action);

}  // namespace toile::testing
