#include "engine/scene/problem.h"
#include "schemas/pointer.h"
#include "schemas/read_scene.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace toile {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;

/// `name` is the file as the scene names it: where it lies on this machine is no business of who sent the scene.
std::string read_file(const fs::path& path, const std::string& name, const std::string& pointer, const char* missing) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw InputError(pointer, missing, "There is no file " + name + ".");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > kMostBytes) {
    throw InputError(pointer, "file_too_large", name + " is larger than 256 MiB.");
  }
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw InputError(pointer, missing, "The file " + name + " can't be read.");
  }
  return bytes;
}

}  // namespace

Resolver file_resolver(fs::path base) {
  return [base = std::move(base)](const nlohmann::json& reference, const std::string& pointer) {
    if (reference.contains("file")) {
      const std::string name = reference["file"].get<std::string>();
      return read_file(base / name, name, child(pointer, "file"), "file_not_found");
    }
    const std::string name = reference.at("asset").get<std::string>();
    const std::string hash = name.substr(std::string("sha256:").size());
    return read_file(base / "assets" / hash, name, child(pointer, "asset"), "asset_not_found");
  };
}

}  // namespace toile
