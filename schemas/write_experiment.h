#pragma once
// What an experiment measured as the document of experiment_result.schema.json, a part of the report.

#include "engine/experiment_report.h"

#include <nlohmann/json_fwd.hpp>

namespace toile {

/// Units as the keys say.
nlohmann::json write_experiment(const ExperimentReport& report);

}  // namespace toile
