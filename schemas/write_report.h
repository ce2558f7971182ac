#pragma once
// The engine's Report as the document of report.schema.json.

#include "engine/report.h"

#include <nlohmann/json_fwd.hpp>

namespace toile {

/// Units as the keys say; stretch in per cent. Throws std::domain_error, naming the key, for a number that is not
/// finite: JSON has none, and a drape that holds one must not be published.
nlohmann::json write_report(const Report& report);

}  // namespace toile
