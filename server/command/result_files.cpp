#include "server/command/result_files.h"

#include "engine/scene/problem.h"
#include "server/queue/artifact.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

namespace toile {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kSceneFileLimit = 64U << 20;  // bytes

}  // namespace

std::string read_input_file(const fs::path& path, std::size_t limit) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  if (!file || !fs::is_regular_file(path, error)) {
    throw InputError("", "file_not_found", "There is no file " + path.string() + ".");
  }
  if (fs::file_size(path) > limit) {
    throw InputError("", "file_too_large", path.string() + " has more than " + std::to_string(limit) + " bytes.");
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

Job read_job(const fs::path& scene) {
  const nlohmann::json document = parse_json(read_input_file(scene, kSceneFileLimit));
  validate_scene_document(document);
  return read_scene(document, file_resolver(scene.parent_path()));
}

void write_atomically(const fs::path& path, std::string_view bytes) {
  const fs::path temporary = path.string() + ".part";
  const auto fail = [&](int descriptor) {
    const std::error_code error(errno, std::generic_category());
    if (descriptor >= 0) close(descriptor);
    unlink(temporary.c_str());
    throw std::system_error(error, "can't write " + path.string());
  };
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(-1);
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      fail(descriptor);
    }
  }
  if (close(descriptor) != 0 || rename(temporary.c_str(), path.c_str()) != 0) fail(-1);
}

void remove_old_results(const fs::path& out) {
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(out)) {
    if (is_artifact_name(entry.path().filename().string())) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

}  // namespace toile
