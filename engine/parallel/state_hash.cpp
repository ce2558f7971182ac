#include "engine/parallel/state_hash.h"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <stdexcept>

namespace toile {

static_assert(std::endian::native == std::endian::little && sizeof(Vec3) == 3 * sizeof(double));

std::string sha256_hex(std::span<const std::byte> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * length);
  for (unsigned int i = 0; i < length; ++i) {
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 15];
  }
  return hex;
}

std::string sha256_hex(const Positions& positions) { return sha256_hex(std::as_bytes(std::span(positions))); }

}  // namespace toile
