#pragma once
// Specimens as garments: one flat outline of cloth, cut at any angle to the warp and put anywhere.

#include "engine/drape.h"
#include "engine/mesh/panel_mesher.h"
#include "engine/scene/experiment.h"

#include <functional>

namespace toile {

/// From weft to the direction [rad].
double angle_of(Direction direction);

/// From a point of the flat specimen [m] to where it is at the start [m].
using Placement = std::function<Vec3(const Vec2&)>;

/// A garment of the mesh, its first axis cut along `angle` [rad] from weft.
Garment specimen(const std::string& name, const FlatMesh& mesh, const Placement& place, double angle,
                 const Fabric& fabric, double edge_length);

/// [0, length] × [0, width], meshed by the panel mesher with edges sampled evenly.
FlatMesh strip_mesh(double length, double width, double edge_length);

/// Vertices of a flat mesh whose first coordinate is this.
std::vector<int> vertices_at(const FlatMesh& mesh, double along);

/// A scene of the specimen alone, as experiments want it: no relaxation, which would bend the cloth without its
/// stiffness and so leave a wrong history in a fabric that rubs, larger steps, and rest by a hundredth of its weight.
Scene experiment_scene(Garment specimen, int threads);

/// drape(), without the warning that a garment of this size fits nobody.
Drape drape_specimen(const Scene& scene, Monitor& monitor);

}  // namespace toile
