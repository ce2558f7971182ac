#pragma once
// From a scene's garments to one simulation mesh: panels meshed apart, placed in the world, seams listed.

#include "engine/mesh/cloth.h"
#include "engine/mesh/triangle_mesh.h"
#include "engine/scene/scene.h"

namespace toile {

inline constexpr long kMaxClothVertices = 2'000'000;

/// Meshes every garment of the scene. Pattern panels: edges sampled uniformly in arc length with ceil(length / h)
/// segments, both sides of a stitch with the larger of the two counts (so ease spreads evenly); inside as
/// mesh_polygon(); placed by the panel's rotation and translation; wound outward, flat corners as drawn, turned about
/// the drawing's origin so that the warp (Garment::panel_grain, else Garment::grain) runs along +v (signed area
/// negative where the loop is clockwise). Garment meshes: as given, flat = UV · uv_unit, stitches made conforming
/// (conforming_seams.h). Fabric of a panel: Garment::panel_fabrics, else Panel::fabric, else the garment's.
/// Nothing is sewn: seam_pairs lists what merge_seams() (sewing.h) will unite. Warnings carry a code before a colon
/// (`implausible_size: …`). Throws InputError (`edge_stitched_twice`, `stitch_missing_panel`, `stitch_missing_edge`,
/// `zero_length_edge`, `self_crossing_panel`, `zero_area_panel`, `missing_uv`, `too_many_vertices`, …).
/// Deterministic.
Cloth build_cloth(const Scene& scene);

/// The cloth as a plain mesh for files and pictures: panels are groups, flat positions are UVs [m].
TriangleMesh surface_mesh(const Cloth& cloth);

}  // namespace toile
