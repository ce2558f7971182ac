#pragma once
// Names of jobs: UUIDv7 (RFC 9562): 48 bits of milliseconds, then 74 random bits from the operating system, so that
// names sort by time and can't be guessed.

#include "server/store/store.h"

#include <string>
#include <string_view>

namespace toile {

std::string make_job_id(TimeMs now);
/// Whether the text has a UUIDv7's form; anything else names no job.
bool is_job_id(std::string_view text);

}  // namespace toile
