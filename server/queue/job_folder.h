#pragma once
// The folder of one run: what the dispatcher lays in it and what it takes out of it. Only its owner may enter (0700);
// it goes when the object goes.

#include "server/queue/artifact.h"
#include "server/store/store.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace toile {

class JobFolder {
 public:
  /// Makes `parent`/`name`-<random>. Throws std::filesystem::filesystem_error.
  JobFolder(const std::filesystem::path& parent, const std::string& name);
  JobFolder(const JobFolder&) = delete;
  JobFolder& operator=(const JobFolder&) = delete;
  ~JobFolder();
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path out() const { return path_ / "out"; }

 private:
  std::filesystem::path path_;
};

/// Writes scene.json, and each asset that it names as assets/<digest>, where schemas/'s file_resolver looks for it.
/// `asset` gives an asset's bytes by its digest. Throws std::runtime_error for an asset that is not there.
void lay_inputs(const JobFolder& folder, const std::string& scene,
                const std::function<std::optional<std::string>(const std::string& digest)>& asset);

/// The artifacts in the run's output folder: regular files whose names the service knows (report.json, mesh.obj,
/// mesh.glb, drape.state, preview-*.png), of kArtifactLimit bytes together at most; the rest is passed over.
std::vector<Artifact> collect_artifacts(const std::filesystem::path& out);

inline constexpr std::size_t kArtifactLimit = 512U << 20;  ///< bytes of one job

}  // namespace toile
