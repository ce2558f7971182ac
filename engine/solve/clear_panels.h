#pragma once
// Puts flat panels where sewing can start: outside the body and not through one another.

#include "engine/mesh/cloth.h"
#include "engine/solve/assemble.h"

#include <vector>

namespace toile {

/// The field each vertex minds while panels are sewn: that without overhangs for panels labelled "leg".
std::vector<const BodyField*> field_of_vertices(const Cloth& apart, const BodyFields& fields);

/// Panels in layer order: one with a point nearer to the body than `clearance`, or with an edge through a triangle of a
/// panel before it, moves along its outward normal until it is free, at most `reach` [m]. Panels that are free stay.
/// Throws InputError (`panel_inside_body`) naming a panel that finds no free place.
void clear_panels(Cloth& apart, const std::vector<const BodyField*>& field, double clearance, double reach);

/// For panels that are not to be moved: throws InputError (`panel_inside_body`) naming one that lies inside the body
/// with all its vertices.
void refuse_enclosed_panels(const Cloth& apart, const std::vector<const BodyField*>& field);

/// Pulls apart what touches itself as drawn: the edges of a slit (for a godet) lie on one another. Vertices whose
/// features are nearer than `gap` to unrelated ones move by `gap` towards the middle of their own triangles.
void open_slits(Cloth& apart, double gap);

/// Layers in one and the same place have no side of each other to be kept on: throws InputError (`coincident_layers`)
/// naming the garment and the place of features that are no farther apart than rounding tells.
void refuse_coincident(const Cloth& cloth);

}  // namespace toile
