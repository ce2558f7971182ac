#pragma once
// The fabric library: one JSON file a fabric in schemas/fabrics/, embedded in the binary.

#include "engine/scene/fabric.h"
#include "engine/scene/stretch_test.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// Names of the library's fabrics, sorted.
std::vector<std::string> fabric_names();

/// The document of a fabric of the library, complete (fabric.schema.json with every number given); nothing for an
/// unknown name.
std::optional<nlohmann::json> fabric_document(std::string_view name);

/// The readings of a valid document's stretch_curve; empty where it has none.
StretchTest stretch_test(const nlohmann::json& document);

/// A fabric from its name or from an inline document that matches fabric.schema.json; keys that are not given come from
/// its base. Throws InputError at `pointer` with the codes unknown_fabric, those of validate_document, and at
/// `pointer`/stretch_curve those of apply_stretch_test.
Fabric read_fabric(const nlohmann::json& name_or_document, const std::string& pointer = "");

}  // namespace toile
