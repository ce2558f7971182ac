#pragma once
// Points of the cloth by their flat coordinates, and how far from the cloth what lies on it begins.

#include "engine/mesh/cloth.h"
#include "engine/scene/scene.h"

#include <optional>

namespace toile {

struct PanelPoint {
  std::size_t triangle;
  std::array<double, 3> weights;  ///< barycentric
};

/// The triangle of the panel that holds a flat point (as Cloth::flat: turned by the grain), the one that holds it best
/// where edges round; nothing off it.
std::optional<PanelPoint> find_on_panel(const Cloth& cloth, int panel, const Vec2& at);

Vec3 position(const Cloth& cloth, const PanelPoint& p);

/// Where a panel's cloth repels its like [m]: half of it is where a trim that lies on the panel leaves the cloth alone.
double layer_spacing(const SolverOptions& solver, const Cloth& cloth, int panel);

}  // namespace toile
