#pragma once
// A sewing pattern: flat panels with curved outlines, placed around a body, and the stitches between their edges.
// Holds what GarmentCode's JSON says (shared/garmentcode-format.md), in metres; built-in rectangles and discs are
// patterns of one panel.

#include "engine/scene/fabric.h"
#include "engine/types.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace toile {

struct StraightEdge {};
/// Quadratic or cubic Bézier; controls relative to the edge: s + u·d + v·n with d = e − s, n = (−d.y, d.x).
struct QuadraticEdge {
  Vec2 control;
};
struct CubicEdge {
  Vec2 control_start, control_end;
};
/// SVG arc in a y-up frame: right = true turns counter-clockwise and bulges to the right of the chord. radius [m]; one
/// below half the chord means half the chord.
struct ArcEdge {
  double radius;
  bool large_arc, right;
};

struct PatternEdge {
  int start, end;  ///< indices into Panel::vertices
  std::variant<StraightEdge, QuadraticEdge, CubicEdge, ArcEdge> curve;
  std::string label;  ///< "" or lower_interface, strapless_top, left_collar, …
};

/// The edges form one closed loop in list order. A counter-clockwise loop shows the right side of the fabric along +z
/// of the panel's frame; a clockwise one along −z. Grain (warp) along +y, unless the
/// garment turns it.
struct Panel {
  std::string name;
  std::string label;           ///< "", "body", "arm", "leg"
  std::vector<Vec2> vertices;  ///< [m]
  std::vector<PatternEdge> edges;
  Mat3 rotation = Mat3::Identity();  ///< panel frame to world: P = rotation · (x, y, 0) + translation
  Vec3 translation = Vec3::Zero();   ///< [m]
  std::optional<Fabric> fabric;      ///< instead of the garment's
};

/// Edge a.edge of panel a meets edge b.edge of panel b: start of a at end of b, or start at start where right_wrong.
struct PatternStitch {
  struct Side {
    int panel, edge;
  } a, b;
  bool right_wrong = false;
};

struct Pattern {
  std::vector<Panel> panels;
  std::vector<PatternStitch> stitches;
};

}  // namespace toile
