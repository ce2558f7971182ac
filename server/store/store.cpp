#include "server/store/store.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace toile {
namespace {

constexpr std::array<std::pair<JobState, std::string_view>, 5> kNames{{{JobState::queued, "queued"},
                                                                       {JobState::running, "running"},
                                                                       {JobState::succeeded, "succeeded"},
                                                                       {JobState::failed, "failed"},
                                                                       {JobState::cancelled, "cancelled"}}};

}  // namespace

std::string_view name_of(JobState state) { return kNames[static_cast<std::size_t>(state)].second; }

std::optional<JobState> job_state_named(std::string_view name) {
  for (const auto& [state, text] : kNames) {
    if (text == name) return state;
  }
  return std::nullopt;
}

std::string failure_document(int status, std::string_view code, std::string_view detail) {
  nlohmann::json document;
  document["type"] = "about:blank";
  document["title"] = "The job failed";
  document["status"] = status;
  document["detail"] = detail;
  document["errors"] = nlohmann::json::array({{{"pointer", ""}, {"code", code}, {"detail", detail}}});
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace toile
