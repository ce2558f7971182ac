#include "server/http/job_document.h"

#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

namespace toile {

std::string rfc3339(TimeMs time) {
  const std::time_t seconds = time / 1000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 64> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text.data() + length, text.size() - length, ".%03dZ", static_cast<int>(time % 1000));
  return text.data();
}

nlohmann::json job_document(const JobRecord& job) {
  const std::string self = "/v1/jobs/" + job.id;
  nlohmann::json document{{"id", job.id},
                          {"state", name_of(job.state)},
                          {"created_at", rfc3339(job.created)},
                          {"attempts", job.attempts},
                          {"links", {{"self", self}}}};
  if (job.started) document["started_at"] = rfc3339(*job.started);
  if (job.finished) document["finished_at"] = rfc3339(*job.finished);
  if (job.state == JobState::queued) document["queue_position"] = job.place_in_queue - 1;
  // Both texts were written by this program from parsed documents.
  if (!job.progress.empty()) document["progress"] = nlohmann::json::parse(job.progress);
  if (!job.problem.empty()) document["error"] = nlohmann::json::parse(job.problem);
  if (job.state == JobState::succeeded) {
    for (const auto& [name, path] : {std::pair{"report", "/report"}, std::pair{"mesh_obj", "/mesh.obj"},
                                     std::pair{"mesh_glb", "/mesh.glb"}, std::pair{"preview", "/preview.png"}}) {
      document["links"][name] = self + path;
    }
  }
  return document;
}

}  // namespace toile
