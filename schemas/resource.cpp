#include "schemas/resource.h"

#include "schemas/resource_table.h"

#include <algorithm>

namespace toile {

std::string_view resource(std::string_view name) {
  for (const Resource& entry : resource_table()) {
    if (entry.name == name) return entry.bytes;
  }
  return {};
}

std::vector<std::string_view> resource_names() {
  std::vector<std::string_view> names;
  for (const Resource& entry : resource_table()) names.push_back(entry.name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace toile
