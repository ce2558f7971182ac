#pragma once
// GarmentCode's JSON into the engine's Pattern.

#include "engine/scene/pattern.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace toile {

struct PatternDocument {
  Pattern pattern;                    ///< panels in order of their names
  std::vector<std::string> warnings;  ///< what was read in a way that its author may not have meant
};

/// Reads a pattern document ({"pattern": {"panels", "stitches"}, "properties"}): straight, quadratic, cubic and circle
/// edges, the legacy bare [u, v], relative and absolute control points; lengths in units_in_meter (the radius of an arc
/// too); placement R = Rz·Ry·Rx; normalize_panel_translation with its quirk (the mean is added to the translation
/// unrotated). Panels keep their loops as drawn.
///
/// Throws InputError with pointers that begin with `pointer` and go on as panels/NAME/edges/3, stitches/5/1 or
/// properties/…, wherever the document itself stands. Codes: those of validate_document, and too_few_edges,
/// vertex_out_of_range, zero_length_edge, open_panel_loop, wrong_curvature, stitch_missing_panel, stitch_missing_edge,
/// edge_stitched_twice. All findings of a kind are reported at once.
PatternDocument read_pattern(const nlohmann::json& document, const std::string& pointer = "");

/// A rectangle or disc as a pattern of one panel in the x–z plane, right side up. Lengths in m.
Pattern rectangle_pattern(double width, double height);
Pattern disc_pattern(double radius);

}  // namespace toile
