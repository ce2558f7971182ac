#pragma once
// Turns one flat outline into near-equilateral triangles. The lattice matters: a hinge model on right-angled triangles
// bends three times stiffer one way than the other (shared/validation/README.md), on this one equally within a few
// per cent.

#include "engine/types.h"

#include <string>
#include <vector>

namespace toile {

/// vertices: first the outline's points as given, in their order, then the inner ones. Triangles counter-clockwise.
struct FlatMesh {
  std::vector<Vec2> vertices;  ///< [m]
  std::vector<Triangle> triangles;
};

/// Meshes the polygon `outline` (either orientation, last point joined to the first) at the target `edge_length` [m].
/// Outline points are kept exactly, none is added, every outline segment is a mesh edge. Inside: hexagonal rows along
/// +x (weft), relaxed (optimal Delaunay smoothing: Alliez et al., SIGGRAPH 2005, eq. 6), constrained Delaunay.
/// Smallest angle is above 20° except where the outline itself forces less (sharp corners, short segments, strips
/// narrower than edge_length). Throws InputError at `pointer`: `panel_too_small` (fewer than 3 points),
/// `zero_area_panel`, `self_crossing_panel`. Deterministic; thread-safe.
FlatMesh mesh_polygon(const std::vector<Vec2>& outline, double edge_length, const std::string& pointer = "");

/// Smallest interior angle of a triangle [rad].
double smallest_angle(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace toile
