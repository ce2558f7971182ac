#include "server/http/preview.h"

#include "server/http/problem_response.h"
#include "server/queue/job_folder.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace toile {
namespace {

/// A turn that was taken, given back at the end of its scope.
struct Turn {
  explicit Turn(std::counting_semaphore<>& turns) : semaphore(turns) {}
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() { semaphore.release(); }
  std::counting_semaphore<>& semaphore;
};

}  // namespace

PreviewRenderer::PreviewRenderer(Store& store, PreviewOptions options)
    : store_(store), options_(std::move(options)), turns_(kPreviewsAtOnce) {
  options_.runner = std::filesystem::absolute(options_.runner).string();
}

std::optional<Artifact> PreviewRenderer::render(const std::string& job_id, const std::string& view,
                                                const std::string& overlay) {
  const std::string name = preview_name(view, overlay);
  if (!turns_.try_acquire_for(options_.patience)) {
    throw HttpProblem(503, "too_many_pictures", "Too many pictures are being drawn.").with_header("Retry-After", "5");
  }
  const Turn turn(turns_);
  if (std::optional<Artifact> drawn = store_.artifact(job_id, name)) return drawn;  // by who was before in the queue
  const std::optional<Artifact> state = store_.artifact(job_id, "drape.state");
  if (!state) return std::nullopt;

  std::filesystem::create_directories(options_.folder);
  const JobFolder folder(options_.folder, job_id + "-preview");
  std::ofstream(folder.out() / state->name, std::ios::binary) << state->bytes;
  ChildWatch watch;
  watch.wall_limit = options_.wall_limit;
  const ChildEnd end = run_child(
      {{options_.runner, "render", "--job", "out", "--view", view, "--overlay", overlay, "--out", "out/" + name},
       folder.path().string(),
       options_.limits},
      watch);
  if (end.how != ChildEnd::How::exited || end.code != 0) {
    throw std::runtime_error("drawing " + name + ": " + describe(end) + ": " + end.stderr_tail);
  }
  for (const Artifact& picture : collect_artifacts(folder.out())) {
    if (picture.name != name) continue;
    store_.add_artifact(job_id, picture);
    return store_.artifact(job_id, name);  // what the store has counts, should another have come first
  }
  throw std::runtime_error("drawing " + name + " left no picture");
}

}  // namespace toile
