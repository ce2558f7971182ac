#pragma once
// Which vertices of a garment are held, and how.

#include "engine/types.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace toile {

struct PinVertices {
  std::vector<int> vertices;  ///< of the garment's mesh as the run writes it
};
struct PinEdge {
  int panel, edge;  ///< a pattern's panel edge
};
struct PinLabel {
  std::string label;  ///< edge label of the pattern, e.g. lower_interface
};
struct PinBox {
  Vec3 min, max;  ///< [m], selects by start position
};
struct PinNearest {
  Vec3 point;  ///< [m], the one vertex nearest to it at the start
};

/// Rigid motion at a time: rotate about `pivot` by the rotation vector, then translate. Linear between key frames,
/// constant before the first and after the last.
struct PinKeyFrame {
  double time = 0;                      ///< [s]
  Vec3 translation = Vec3::Zero();      ///< [m]
  Vec3 rotation_vector = Vec3::Zero();  ///< [rad]
};

struct PinFixed {};
struct PinMoved {
  Vec3 pivot = Vec3::Zero();
  std::vector<PinKeyFrame> key_frames;  ///< times rising
};
/// Attached to the body where assembly puts it (a waistband, a strapless top): held there, or sliding along the body's
/// surface with Coulomb friction, without leaving it.
struct PinAttached {
  bool slides = false;
  std::optional<double> friction;  ///< of what slides; none: the body's
};

using Selection = std::variant<PinVertices, PinEdge, PinLabel, PinBox, PinNearest>;

struct Pin {
  Selection select;
  std::variant<PinFixed, PinMoved, PinAttached> hold;
  /// Whether the tangent is held, too: along the mesh edges between its vertices the cloth leaves in the plane in which
  /// it lies at the start of the drape. Without it, pinned vertices are a hinge.
  bool clamp = false;
};

}  // namespace toile
