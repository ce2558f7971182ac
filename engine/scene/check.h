#pragma once
// Whether a scene can be simulated at all, asked before anything is meshed.

#include "engine/scene/problem.h"
#include "engine/scene/scene.h"

#include <vector>

namespace toile {

inline constexpr std::size_t kMaxPanels = 500;  ///< of one garment
inline constexpr double kMaxVertices = 2e6;     ///< estimated, of the whole scene
inline constexpr double kMinEdgeLength = 1e-3;  ///< [m]
inline constexpr double kMaxEdgeLength = 0.1;   ///< [m]

/// Everything that is wrong with the scene, in the order of the document; empty if it can be simulated. Checks that
/// numbers are finite and inside physical ranges, indices and names refer to something, panel outlines are closed,
/// simple and have an area, no edge is stitched twice, garment meshes are manifold with a flat shape, and the size
/// limits above. Pointers as in mesh/pattern_pointer.h. Never throws InputError; pure and thread-safe.
/// Codes: empty_scene, empty_garment, not_finite, edge_length_range, fabric_value, unknown_panel, too_many_panels,
/// too_many_vertices, duplicate_panel, too_few_edges, vertex_out_of_range, open_panel_loop, zero_length_edge,
/// zero_area_panel, self_crossing_panel, stitch_missing_panel, stitch_missing_edge, edge_stitched_twice, missing_uv,
/// zero_area_triangle, non_manifold_mesh, unknown_label, unknown_edge, empty_box, times_not_rising, pin_value,
/// attached_without_body, body_value, empty_body, solver_value, trim_value, selects_no_edge.
std::vector<Problem> scene_problems(const Scene& scene);

/// Throws InputError with all of scene_problems() if there are any.
void check_scene(const Scene& scene);

}  // namespace toile
