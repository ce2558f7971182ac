#include "tests/validation/references.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace toile::test {

namespace {

const char* const kPath = TOILE_SHARED "/validation/references.json";

const nlohmann::json& all() {
  static const nlohmann::json document = [] {
    std::ifstream file(kPath);
    return nlohmann::json::parse(file);
  }();
  return document;
}

}  // namespace

bool have_references() { return std::filesystem::exists(kPath); }

double reference(const std::string& pointer) { return all().at(nlohmann::json::json_pointer(pointer)).get<double>(); }

int reference_row(const std::string& list_pointer, const std::string& key, double value) {
  const auto& list = all().at(nlohmann::json::json_pointer(list_pointer));
  for (std::size_t i = 0; i < list.size(); ++i)
    if (std::abs(list[i].at(key).get<double>() - value) <= 1e-9 * std::abs(value)) return static_cast<int>(i);
  throw std::out_of_range("no row with " + key + " in " + list_pointer);
}

}  // namespace toile::test
