#include "schemas/parse_json.h"
#include "schemas/pointer.h"
#include "schemas/read_scene.h"
#include "server/http/job_document.h"
#include "server/http/problem_response.h"
#include "server/http/service.h"
#include "server/store/digest.h"
#include "server/store/job_id.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using nlohmann::json;

constexpr std::size_t kIdempotencyKeyLimit = 200;  // characters

HttpResponse json_response(int status, const json& document) {
  return {status, "application/json", document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n", {}};
}

/// Where {"asset": name} stands first in the document; depth is bounded by the parser.
std::string pointer_to_asset(const json& node, const std::string& name, const std::string& pointer) {
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) {
      if (key == "asset" && value.is_string() && value.get_ref<const std::string&>() == name)
        return child(pointer, key);
      std::string found = pointer_to_asset(value, name, child(pointer, key));
      if (!found.empty()) return found;
    }
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      std::string found = pointer_to_asset(node[i], name, child(pointer, i));
      if (!found.empty()) return found;
    }
  }
  return {};
}

/// Parses {"scene": {…}} or {"experiment": {…}}; pointers of what the parser throws are made to point into the scene.
json parse_request(const std::string& body) {
  try {
    return parse_json(body, {.bytes = kSceneLimit, .depth = JsonLimits{}.depth + 1});
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      constexpr std::string_view kScene = "/scene";
      if (problem.pointer == kScene || problem.pointer.rfind("/scene/", 0) == 0)
        problem.pointer.erase(0, kScene.size());
    }
    throw InputError(std::move(problems));
  }
}

/// The scene of {"scene": {…}}, checked as far as it can be without another document, or an experiment's document as it
/// is. Throws InputError with pointers into the scene, as a run's problems have them.
json checked_scene(const std::string& body, Store& store) {
  json document = parse_request(body);
  if (is_experiment(document)) {
    validate_scene_document(document, FileReferences::refused);
    return document;
  }
  if (!document.is_object() || !document.contains("scene")) {
    throw InputError("", "missing_key", "The body must be an object with the key \"scene\" or \"experiment\".");
  }
  for (const auto& [key, value] : document.items()) {
    if (key != "scene")
      throw InputError("", "unknown_key", "The body has the key \"" + key + "\", which means nothing.");
  }
  json scene = std::move(document["scene"]);
  validate_scene_document(scene, FileReferences::refused);
  std::vector<Problem> missing;
  for (const std::string& name : asset_references(scene)) {
    if (!store.has_asset(std::string(digest_of_asset_name(name)))) {
      missing.push_back({pointer_to_asset(scene, name, ""), "asset_not_found",
                         "There is no asset " + name + " here; send its bytes to POST /v1/assets first."});
    }
  }
  if (!missing.empty()) throw InputError(std::move(missing));
  return scene;
}

std::optional<std::string> idempotency_key(const HttpRequest& request) {
  std::optional<std::string> key = request.header("idempotency-key");
  if (!key) return key;
  const bool printable = std::all_of(key->begin(), key->end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (key->empty() || key->size() > kIdempotencyKeyLimit || !printable) {
    throw HttpProblem(400, "bad_idempotency_key", "Idempotency-Key must be 1 to 200 printable ASCII characters.");
  }
  return key;
}

HttpResponse submit(Service& service, const HttpRequest& request) {
  const std::optional<std::string> key = idempotency_key(request);
  const json scene = checked_scene(request.body, service.store);
  if (service.store.queued_jobs() >= service.options.max_queued) {
    throw HttpProblem(429, "queue_full", "Too many jobs wait already.").with_header("Retry-After", "30");
  }
  const TimeMs now = service.clock();
  const Submission submission =
      service.store.submit({make_job_id(now), scene.dump(), sha256_hex(request.body), key}, now);
  if (submission.kind == Submission::Kind::key_reused) {
    throw HttpProblem(422, "idempotency_key_reused", "This Idempotency-Key was used with another body.");
  }
  service.dispatcher.notify();
  HttpResponse response = json_response(202, job_document(submission.job));
  response.headers.emplace_back("Location", "/v1/jobs/" + submission.job.id);
  return response;
}

JobRecord job_or_404(Service& service, const std::string& id) {
  std::optional<JobRecord> job;
  if (is_job_id(id)) job = service.store.job(id);
  if (!job) throw HttpProblem(404, "no_such_job", "There is no job of this id.");
  return *job;
}

HttpResponse show(Service& service, const HttpRequest& request) {
  HttpResponse response = json_response(200, job_document(job_or_404(service, request.captures[0])));
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

HttpResponse list(Service& service, const HttpRequest& request) {
  std::optional<JobState> state;
  std::string cursor;
  int limit = kPageDefault;
  for (const auto& [name, value] : request.query) {
    if (name == "state") {
      state = job_state_named(value);
      if (!state) {
        throw HttpProblem(400, "bad_query", "state must be queued, running, succeeded, failed or cancelled.");
      }
    } else if (name == "cursor") {
      if (!is_job_id(value)) throw HttpProblem(400, "bad_query", "cursor must be the next_cursor of a page.");
      cursor = value;
    } else if (name == "limit") {
      const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), limit);
      if (error != std::errc() || end != value.data() + value.size() || limit < 1 || limit > kPageLimit) {
        throw HttpProblem(400, "bad_query", "limit must be a number from 1 to " + std::to_string(kPageLimit) + ".");
      }
    } else {
      throw HttpProblem(400, "bad_query", "The query takes state, cursor and limit.");
    }
  }
  const JobPage page = service.store.jobs(state, cursor, limit);
  json document{{"jobs", json::array()}};
  for (const JobRecord& job : page.jobs) document["jobs"].push_back(job_document(job));
  if (!page.next_cursor.empty()) document["next_cursor"] = page.next_cursor;
  HttpResponse response = json_response(200, document);
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

HttpResponse cancel(Service& service, const HttpRequest& request) {
  const std::string id = job_or_404(service, request.captures[0]).id;
  const CancelOutcome outcome = service.store.cancel(id, service.clock());
  service.dispatcher.notify();
  const JobRecord job = job_or_404(service, id);
  if (outcome == CancelOutcome::already_final && job.state != JobState::cancelled) {
    throw HttpProblem(409, "job_finished", "The job has " + std::string(name_of(job.state)) + " already.");
  }
  return json_response(202, job_document(job));
}

}  // namespace

void add_job_routes(Router& router, Service& service) {
  const auto with_service = [&service](HttpResponse (*handler)(Service&, const HttpRequest&)) {
    return [&service, handler](const HttpRequest& request) { return handler(service, request); };
  };
  router.add({"POST", "/v1/jobs", with_service(submit), {kSceneLimit, true}});
  router.add({"GET", "/v1/jobs", with_service(list), {}});
  router.add({"GET", "/v1/jobs/{}", with_service(show), {}});
  router.add({"DELETE", "/v1/jobs/{}", with_service(cancel), {}});
}

}  // namespace toile
