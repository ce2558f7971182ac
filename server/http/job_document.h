#pragma once
// A job as the API shows it.

#include "server/store/store.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace toile {

/// As job.schema.json has it; times as in RFC 3339 with milliseconds, UTC.
nlohmann::json job_document(const JobRecord& job);

std::string rfc3339(TimeMs time);

}  // namespace toile
