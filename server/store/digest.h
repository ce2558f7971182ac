#pragma once
// SHA-256 of bytes: the names of assets and the ETags of artifacts.

#include <string>
#include <string_view>

namespace toile {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// Whether the text is 64 lower-case hexadecimal digits.
bool is_sha256_hex(std::string_view text);

/// From "sha256:<64 digits>" the digits; empty for anything else.
std::string_view digest_of_asset_name(std::string_view name);

}  // namespace toile
