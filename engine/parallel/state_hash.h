#pragma once
// The hash that pins a state: equal hashes mean equal bytes.

#include "engine/types.h"

#include <cstddef>
#include <span>
#include <string>

namespace toile {

/// SHA-256 of the bytes, 64 lower-case hexadecimal digits. Throws std::runtime_error when the library refuses.
std::string sha256_hex(std::span<const std::byte> bytes);

/// Of the coordinates as little-endian doubles, x y z per vertex.
std::string sha256_hex(const Positions& positions);

}  // namespace toile
