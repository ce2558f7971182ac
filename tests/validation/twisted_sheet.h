#pragma once
// The first seed's synthetic scene (its section 4.2.2): a square of 1 m², two opposite sides clamped; after 0.5 s one
// of them turns by 0.75 π within 1 s about the line through both middles; it ends at 3 s. Stretch, bending and
// self-collision, on a coarse or fine mesh, of a stiff woven or a soft knitted fabric.

#include "engine/mesh/build_cloth.h"
#include "engine/quality/intersections.h"
#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <memory>

namespace toile::test {

/// Of the kinds that the paper names; its appendix with their numbers is not at hand.
inline Fabric stiff_woven() {
  Fabric fabric = isotropic_fabric(0.25, 5000, 300, 1000, 3e-5);
  fabric.friction_cloth = 0.4;
  return fabric;
}
inline Fabric soft_knit() {
  Fabric fabric = isotropic_fabric(0.18, 150, 40, 50, 3e-6);
  fabric.friction_cloth = 0.4;
  return fabric;
}

struct TwistedSheet {
  Cloth cloth;
  SimulationScene scene;
  std::unique_ptr<PinMoved> turn;  ///< the moving clamp's motion, which the scene points to

  TwistedSheet(const Fabric& fabric, double edge_length) : turn(std::make_unique<PinMoved>()) {
    Scene described;
    described.garments = {garment_of(Pattern{{rectangle_panel("sheet", 1, 1)}, {}}, edge_length)};
    described.garments[0].fabric = fabric;
    cloth = build_cloth(described);
    for (Vec3& p : cloth.x) p = Vec3(p.x(), 0, p.y() - 0.5);  // clamped at z = ±½
    turn->key_frames = {{0.5, Vec3::Zero(), Vec3::Zero()},
                        {1.5, Vec3::Zero(), 0.75 * std::numbers::pi * Vec3::UnitZ()}};
    for (std::size_t v = 0; v < cloth.x.size(); ++v)
      if (std::abs(cloth.x[v].z()) > 0.5 - 1e-9)
        scene.held.push_back({static_cast<int>(v), cloth.x[v], cloth.x[v].z() > 0 ? turn.get() : nullptr});
    scene.options.early_stop = false;
    scene.options.simulated_time_limit = 3;
  }

  Simulation run() {
    return simulate(cloth, scene, [](const SimulationState&) { return true; });
  }
};

}  // namespace toile::test
