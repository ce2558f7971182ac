#pragma once
// The bodies that have closed forms. Exact distances everywhere; where the gradient is not unique (the centre of a
// sphere, the axis of a capsule, the medial planes of a box) one of the nearest directions is returned.

#include "engine/geometry/solid.h"
#include "engine/scene/body.h"

namespace toile {

std::shared_ptr<const Solid> make_solid(const SphereBody& sphere);
std::shared_ptr<const Solid> make_solid(const CapsuleBody& capsule);
std::shared_ptr<const Solid> make_solid(const CylinderBody& cylinder);
std::shared_ptr<const Solid> make_solid(const BoxBody& box);
std::shared_ptr<const Solid> make_solid(const PlaneBody& plane);

}  // namespace toile
