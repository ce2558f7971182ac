#include "server/queue/job_folder.h"

#include "schemas/parse_json.h"
#include "schemas/read_scene.h"
#include "server/store/digest.h"
#include "server/store/job_id.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace toile {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("can't write " + path.filename().string());
}

/// The file's bytes if it is a regular one of at most `limit` bytes. A link is not followed: what a run leaves behind
/// is not trusted.
std::optional<std::string> read_regular_file(const fs::path& path, std::size_t limit) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  struct stat status {};
  std::optional<std::string> bytes;
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && static_cast<std::size_t>(status.st_size) <= limit) {
    bytes.emplace(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes->size()) {
      const ssize_t count = read(descriptor, bytes->data() + done, bytes->size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    if (done != bytes->size()) bytes.reset();
  }
  close(descriptor);
  return bytes;
}

}  // namespace

JobFolder::JobFolder(const fs::path& parent, const std::string& name) {
  const std::string random = make_job_id(0).substr(19);
  path_ = parent / (name + "-" + random);
  for (const fs::path& folder : {path_, path_ / "assets", path_ / "out"}) {
    if (mkdir(folder.c_str(), 0700) != 0) {
      throw fs::filesystem_error("can't make the run's folder", folder,
                                 std::error_code(errno, std::generic_category()));
    }
  }
}

JobFolder::~JobFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void lay_inputs(const JobFolder& folder, const std::string& scene,
                const std::function<std::optional<std::string>(const std::string& digest)>& asset) {
  write_file(folder.path() / "scene.json", scene);
  for (const std::string& name : asset_references(parse_json(scene))) {
    const std::string digest(digest_of_asset_name(name));
    const std::optional<std::string> bytes = asset(digest);
    if (!bytes) throw std::runtime_error("the asset " + name + " is gone");
    write_file(folder.path() / "assets" / digest, *bytes);
  }
}

std::vector<Artifact> collect_artifacts(const fs::path& out) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(out, error)) {
    const std::string name = entry.path().filename().string();
    if (is_artifact_name(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  std::vector<Artifact> artifacts;
  std::size_t room = kArtifactLimit;
  for (const std::string& name : names) {
    std::optional<std::string> bytes = read_regular_file(out / name, room);
    if (!bytes) continue;
    room -= bytes->size();
    artifacts.push_back(make_artifact(name, std::move(*bytes)));
  }
  return artifacts;
}

}  // namespace toile
