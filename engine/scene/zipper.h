#pragma once
// Two edges of a garment that a zipper holds together, and what the zipper itself weighs and resists.

#include "engine/scene/pin.h"

namespace toile {

/// A rigid end: a box across, along and through the chain.
struct ZipperEnd {
  Vec3 size = Vec3::Zero();  ///< [m]
  double mass = 0;           ///< [kg]
};

/// The sides are sewn to each other from the bottom up to the slider, and free above it. The tapes with their teeth
/// follow both edges: mass, tension (terms/elastic.h) and bending (terms/tape.h), of which each side has half where it
/// is open. Slider and stops are rigid bodies on springs, as buttons are.
struct Zipper {
  /// Edges of a pattern's panels: their runs start where the first edge does, or end there with `from_end`; the second
  /// one runs against the first, as in a stitch. Or vertices of the mesh as given, from the bottom up, as many on
  /// either side.
  using Side = std::variant<PinEdge, PinVertices>;
  std::array<Side, 2> sides;
  bool from_end = false;
  double closed_fraction = 1;     ///< of the length, to the nearest vertex of the mesh
  double mass_per_length = 0.02;  ///< of both tapes and the teeth [kg/m]
  double stiffness = 2000;        ///< of both tapes together [N] per strain
  double bending = 4e-5;          ///< of the closed chain along its line [N·m²]
  double damping = 2e-2;          ///< β of the tapes [s]
  ZipperEnd slider{{8e-3, 11e-3, 5e-3}, 2.5e-3}, stop{{5e-3, 4e-3, 3e-3}, 0.2e-3};
  double thread_stiffness = 1000;  ///< of one end's springs together [N/m]
  double thread_damping = 5e-3;    ///< β [s]
  double friction = 0.2;           ///< Coulomb coefficient of the ends against cloth and body
};

}  // namespace toile
