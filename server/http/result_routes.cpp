#include "server/http/problem_response.h"
#include "server/http/service.h"
#include "server/queue/artifact.h"
#include "server/store/job_id.h"

#include <algorithm>
#include <array>

namespace toile {
namespace {

constexpr std::array<std::string_view, 6> kViews{"front", "back", "left", "right", "three-quarter", "top"};
constexpr std::array<std::string_view, 4> kOverlays{"fabric", "stretch", "contact", "wireframe"};

/// Whether If-None-Match names this ETag (RFC 9110, weak comparison).
bool is_known(const HttpRequest& request, const std::string& etag) {
  const std::string known = request.header("if-none-match").value_or("");
  return known == "*" || known.find(etag) != std::string::npos;
}

HttpResponse serve(const HttpRequest& request, Artifact artifact) {
  const std::string etag = "\"" + artifact.sha256 + "\"";
  HttpResponse response;
  response.headers = {{"ETag", etag}, {"Cache-Control", "private, max-age=31536000, immutable"}};
  if (is_known(request, etag)) {
    response.status = 304;
    return response;
  }
  response.content_type = artifact.media_type;
  response.body = std::move(artifact.bytes);
  return response;
}

/// Throws the problem of a job that has no such result (404 for no such job, 409 for the rest).
[[noreturn]] void refuse(Service& service, const std::string& id) {
  std::optional<JobRecord> job;
  if (is_job_id(id)) job = service.store.job(id);
  if (!job) throw HttpProblem(404, "no_such_job", "There is no job of this id.");
  if (!is_final(job->state)) {
    throw HttpProblem(409, "job_not_finished", "The job is " + std::string(name_of(job->state)) + ".");
  }
  throw HttpProblem(409, "job_has_no_result",
                    "The job is " + std::string(name_of(job->state)) +
                        " and left no such result; its problem, if any, "
                        "is in GET /v1/jobs/" +
                        job->id + ".");
}

HttpResponse artifact(Service& service, const HttpRequest& request, const std::string& name) {
  const std::string& id = request.captures[0];
  std::optional<Artifact> found;
  if (is_job_id(id)) found = service.store.artifact(id, name);
  if (!found) refuse(service, id);
  return serve(request, std::move(*found));
}

/// One of `allowed`; the first when the query does not say.
template <std::size_t N>
std::string choice(const HttpRequest& request, const char* name, const std::array<std::string_view, N>& allowed) {
  const auto given = request.query.find(name);
  if (given == request.query.end()) return std::string(allowed[0]);
  if (std::find(allowed.begin(), allowed.end(), given->second) == allowed.end()) {
    std::string list;
    for (const std::string_view word : allowed) list += (list.empty() ? "" : ", ") + std::string(word);
    throw HttpProblem(400, "bad_query", std::string(name) + " must be one of " + list + ".");
  }
  return given->second;
}

HttpResponse preview(Service& service, const HttpRequest& request) {
  const std::string view = choice(request, "view", kViews), overlay = choice(request, "overlay", kOverlays);
  const std::string& id = request.captures[0];
  if (!is_job_id(id)) refuse(service, id);
  std::optional<Artifact> found = service.store.artifact(id, preview_name(view, overlay));
  if (!found) found = service.previews.render(id, view, overlay);
  if (!found) refuse(service, id);
  return serve(request, std::move(*found));
}

}  // namespace

void add_result_routes(Router& router, Service& service) {
  for (const auto& [path, name] :
       {std::pair{"/v1/jobs/{}/report", "report.json"}, std::pair{"/v1/jobs/{}/mesh.obj", "mesh.obj"},
        std::pair{"/v1/jobs/{}/mesh.glb", "mesh.glb"}}) {
    router.add(
        {"GET",
         path,
         [&service, name = std::string(name)](const HttpRequest& request) { return artifact(service, request, name); },
         {}});
  }
  router.add({"GET",
              "/v1/jobs/{}/preview.png",
              [&service](const HttpRequest& request) { return preview(service, request); },
              {}});
}

}  // namespace toile
