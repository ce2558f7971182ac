#pragma once
// What is sewn onto a garment and carries force of its own.

#include "engine/scene/pin.h"

namespace toile {

/// Elastic along edges (a waistband, a cuff): each edge pulls towards `length_factor` times its flat length, with
/// `stiffness` newtons per strain of the elastic; a band that is slack does nothing (terms/elastic.h).
struct Elastic {
  Selection select;  ///< edges; PinNearest selects none
  double length_factor = 1;
  double stiffness = 30;  ///< [N]
  double damping = 2e-2;  ///< β [s]
};

/// A cord in a channel along edges, in which it slides freely: of each connected chain of edges the total length pulls
/// towards `length` (terms/drawcord.h).
struct Drawcord {
  Selection select;
  double length = 0;        ///< of the cord within the channel [m]
  double stiffness = 1000;  ///< [N]
  double damping = 2e-2;    ///< β [s]
};

/// A disc.
struct Button {
  double diameter = 11.5e-3, thickness = 2.5e-3;  ///< [m]
  double mass = 0.4e-3;                           ///< [kg]
};

/// A place on a panel, where a button's thread goes through it.
struct TrimHole {
  std::string panel;       ///< name
  Vec2 at = Vec2::Zero();  ///< in the panel's flat coordinates [m]
};

/// A button on the right side of the cloth at its first hole, and the layers that its thread holds beneath it, in that
/// order. Each layer is held by four springs around the hole (terms/attachment.h); what it touches pushes it
/// (terms/trim_contact.h).
struct Trim {
  Button button;
  std::vector<TrimHole> holes;  ///< at least one
  double stiffness = 1000;      ///< of the springs of one layer together [N/m]
  double damping = 5e-3;        ///< β [s]
  double friction = 0.2;        ///< Coulomb coefficient of the button against cloth and body
};

}  // namespace toile
