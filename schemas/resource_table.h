#pragma once
// The generated table behind resource.h.

#include <span>
#include <string_view>

namespace toile {

struct Resource {
  std::string_view name, bytes;
};

/// All embedded files.
std::span<const Resource> resource_table();

}  // namespace toile
