#pragma once
// Pictures that nobody asked for when the job was sent: drawn by a child process (`toile render`) from the run's kept
// state, then kept as an artifact of the job. The server process itself never touches OpenGL or a mesh.

#include "server/queue/child_process.h"
#include "server/store/store.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <semaphore>
#include <string>

namespace toile {

struct PreviewOptions {
  std::string runner;            ///< executable that understands `render --job DIR --view V --overlay O --out FILE`
  std::filesystem::path folder;  ///< parent of the drawings' folders
  ChildLimits limits;
  std::chrono::milliseconds wall_limit{60'000};
  std::chrono::milliseconds patience{20'000};  ///< that a request waits for its turn
};

/// Thread-safe. Draws kPreviewsAtOnce pictures at once, the rest wait.
class PreviewRenderer {
 public:
  PreviewRenderer(Store& store, PreviewOptions options);
  /// The picture, drawn and stored; nothing when the job has no state to draw from. Throws HttpProblem 503 when its
  /// turn does not come in time, std::runtime_error when the drawing fails.
  std::optional<Artifact> render(const std::string& job_id, const std::string& view, const std::string& overlay);

 private:
  Store& store_;
  PreviewOptions options_;
  std::counting_semaphore<> turns_;
};

inline constexpr int kPreviewsAtOnce = 2;

}  // namespace toile
