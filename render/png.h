#pragma once
// PNG to memory.

#include <cstdint>
#include <span>
#include <vector>

namespace toile {

/// 8-bit sRGB pixels, `rgb` of 3·width·height bytes, top row first. Throws std::runtime_error when libpng fails.
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgb, int width, int height);

}  // namespace toile
