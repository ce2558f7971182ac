#pragma once
// A fitted fabric as a document for scenes, and how well it fits.

#include "engine/fabric_fit.h"

#include <nlohmann/json_fwd.hpp>

namespace toile {

/// A complete document of fabric.schema.json: the base's, with what was measured in place; name, composition and the
/// like from the measurements' document.
nlohmann::json write_fabric(const FabricFit& fit, const nlohmann::json& measurements);

/// The document of fabric_fit.schema.json.
nlohmann::json write_fabric_fit(const FabricFit& fit);

}  // namespace toile
