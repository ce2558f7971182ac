#pragma once
// A laboratory's measurements of one cloth, from their document (measurements.schema.json).

#include "engine/scene/fabric_measurements.h"

#include <nlohmann/json_fwd.hpp>

namespace toile {

/// Throws InputError: the codes of validate_document, unknown_fabric (at /base), key_not_of_form (an angle or a drop
/// where it has no meaning) and those of measurement_problems().
FabricMeasurements read_measurements(const nlohmann::json& document);

}  // namespace toile
