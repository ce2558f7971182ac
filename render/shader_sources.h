#pragma once
// The text of shaders/<name>.glsl, built into the program.

#include <string_view>

namespace toile {

/// Throws std::runtime_error for an unknown name. Lives as long as the program.
std::string_view shader_source(std::string_view name);

}  // namespace toile
