#pragma once
// Where trims begin: on the sewn cloth, over their holes.

#include "engine/mesh/triangle_mesh.h"
#include "engine/solve/trimmings.h"

namespace toile {

/// Adds every trim of the scene and its springs. A button starts on the right side of the cloth over its first hole,
/// its axes along the cloth's there. In each layer four springs hold the points of the cloth a sixth of a diameter
/// around the hole, along the button's axes, to the same points beneath the button: the first layer at half a contact
/// distance from its face, each next one a contact distance farther, so that the thread is slack where layers touch.
/// Throws InputError (`trim_off_panel`) at the place whose hole, or whose springs, lie outside the panel.
void place_trims(const Scene& scene, const Cloth& sewn, Trimmings& trimmings);

/// Appends the trims as they look to a mesh, for pictures.
void append_trims(const std::vector<RigidTrim>& trims, TriangleMesh& mesh);

}  // namespace toile
