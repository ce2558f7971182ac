#include "tests/schemas/files.h"

#include "schemas/parse_json.h"
#include "schemas/read_pattern.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace toile::testing {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("can't read " + path.string());
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

nlohmann::json json_from(const std::filesystem::path& path) { return parse_json(bytes_of(path)); }

Pattern pattern_from(const std::filesystem::path& path) { return read_pattern(json_from(path)).pattern; }

std::vector<Problem> problems_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace toile::testing
