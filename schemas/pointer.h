#pragma once
// JSON pointers (RFC 6901) as strings.

#include <cstddef>
#include <string>
#include <string_view>

namespace toile {

/// `pointer` extended by an object's key, with ~ and / escaped.
std::string child(std::string pointer, std::string_view key);
/// `pointer` extended by an array's index.
std::string child(std::string pointer, std::size_t index);

}  // namespace toile
