#pragma once
// Whole scenes of a few hundred vertices: a square on a ball, a skirt on a cylinder.

#include "tests/engine/solve/scenes.h"

namespace toile::test {

/// A square sheet over a ball of 10 cm; damped, so that it comes to rest soon.
inline Scene ball_scene(double edge_length = 0.02) {
  Scene scene;
  scene.garments = {square_garment(0.2, edge_length, 0.105)};
  scene.garments[0].fabric.bending_damping = 0.2;
  scene.body = Body{SphereBody{Vec3::Zero(), 0.1}, 0.3};
  return scene;
}

/// A short skirt whose waist is held to the cylinder.
inline Scene skirt_scene() {
  Scene scene = tube_scene(0.03);
  Pattern skirt = tube_pattern(0.345, 0.12, 0.14, -0.06);
  for (Panel& panel : skirt.panels) panel.edges[2].label = "lower_interface";
  scene.garments[0].shape = skirt;
  scene.garments[0].pins = {{PinLabel{"lower_interface"}, PinAttached{}}};
  return scene;
}

}  // namespace toile::test
