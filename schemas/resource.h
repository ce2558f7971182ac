#pragma once
// The files of schemas/ that travel inside the binary: "scene.schema.json", "openapi.json", "fabrics/poplin.json", …

#include <string_view>
#include <vector>

namespace toile {

/// The bytes of the embedded file of that name; empty where there is none. Lives as long as the program.
std::string_view resource(std::string_view name);

/// The names of all embedded files, sorted.
std::vector<std::string_view> resource_names();

}  // namespace toile
