#pragma once
// How well a fitted fabric answers to its measurements, as a table for people.

#include "engine/fabric_fit.h"

#include <string>

namespace toile {

std::string fit_table(const FabricFit& fit);

}  // namespace toile
