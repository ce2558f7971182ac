#pragma once
// What a drape cost and what it is worth, as a table for people.

#include "engine/report.h"

#include <string>

namespace toile {

std::string cost_table(const Report& report);

/// Without what it cost.
std::string worth_table(const Report& report);

}  // namespace toile
