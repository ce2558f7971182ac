#pragma once
// A fitted fabric as a document for scenes, and how well it fits.

#include "engine/fabric_fit.h"

#include <nlohmann/json_fwd.hpp>

namespace toile {

/// What a number of a fit is said in: its key in a document, its symbol in a table, and its size in SI units.
struct FitUnit {
  const char* key;
  const char* symbol;
  double size;
};
FitUnit unit_of(MisfitRow::Quantity quantity);
FitUnit unit_of(const ParameterEstimate& parameter);  ///< of a value without a strain, which is a factor with one

/// A complete document of fabric.schema.json: the base's, with what was measured in place; name, composition and the
/// like from the measurements' document.
nlohmann::json write_fabric(const FabricFit& fit, const nlohmann::json& measurements);

/// The document of fabric_fit.schema.json.
nlohmann::json write_fabric_fit(const FabricFit& fit);

}  // namespace toile
