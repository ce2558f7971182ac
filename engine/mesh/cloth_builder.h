#pragma once
// The two ways a garment becomes part of a cloth; build_cloth() calls them.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

namespace toile {

/// Adds one pattern garment: panels, labels, seam pairs. Errors as build_cloth().
void add_pattern(const Garment& garment, const Pattern& pattern, int garment_index, Cloth& cloth);

/// Adds one mesh garment; groups become panels. Errors as build_cloth().
void add_garment_mesh(const Garment& garment, const GarmentMesh& shape, int garment_index, Cloth& cloth);

/// Adds the garment's seams, where they bend otherwise than the cloth, and its folds to cloth.creases, folds last; the
/// garment's vertices start at `first_vertex` and its triangles at `first_triangle`. Throws InputError
/// (`fold_not_on_mesh`) at /garments/i/folds/j for a fold that no edge of the mesh follows.
void add_creases(const Garment& garment, int garment_index, int first_vertex, int first_triangle, Cloth& cloth);

/// Index into cloth.fabrics of a panel's fabric; adds it at first use.
int fabric_of(const Garment& garment, const std::string& panel_name, const Fabric* panel_fabric, Cloth& cloth);

/// Where a panel's warp runs [rad], counter-clockwise from +y of the drawing.
double grain_of(const Garment& garment, const std::string& panel_name);

/// Turns what is drawn so that the warp runs along +v. A grain of 0 leaves every bit as it is.
Vec2 turned_to_grain(double grain, const Vec2& drawn);
void turn_to_grain(double grain, std::array<Vec2, 3>& flat);

}  // namespace toile
