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

}  // namespace toile
