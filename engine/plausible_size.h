#pragma once
// Whether garments are as large, and where, as their documents mean them to be: units are what goes wrong most.

#include "engine/geometry/body_field.h"
#include "engine/mesh/cloth.h"
#include "engine/quality/warnings.h"
#include "engine/scene/problem.h"
#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace toile {

/// Sewn garments whose size beside the body says that they were drawn in another unit than their document names. A
/// panel over 3 m that is over twice as long as the body is refused, since sewing it would only take long (throws
/// InputError `implausible_size` at the garment); of a panel over twice as long as a small body, and of a tiny garment,
/// a warning is left in the cloth. Bodies without end (planes) tell nothing.
void check_size(Cloth& cloth, const BodyField& body);

/// Of garments given as meshes: how large they are in space beside their flat pattern, the root of the areas' ratio.
/// Ten times off either way is refused (throws InputError `implausible_uv_unit` at the garment's mesh); of what is off
/// by over a fifth a warning is left in the cloth, since it starts as much stretched or compressed.
void check_flat_size(Cloth& cloth, const std::vector<char>& given_as_mesh);

/// Throws InputError `empty_garment` where sewing leaves no triangle of a garment: then its edges are too long for it.
void check_something_is_left(const Cloth& apart);

/// Garments without pins that hold them in space are meant to be on the body.
NearBody near_body(const Scene& scene, const Cloth& cloth);

/// What was found odd about sizes explains best why panels can't be sewn.
[[noreturn]] void rethrow_with_sizes(const InputError& error, const std::vector<std::string>& warnings);

}  // namespace toile
