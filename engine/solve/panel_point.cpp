#include "engine/solve/panel_point.h"

#include "engine/contact/collision_mesh.h"

#include <Eigen/LU>

#include <algorithm>

namespace toile {

std::optional<PanelPoint> find_on_panel(const Cloth& cloth, int panel, const Vec2& at) {
  std::optional<PanelPoint> best;
  double inside = -1e-9;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    if (cloth.triangle_panel[t] != panel) continue;
    const auto& f = cloth.flat[t];
    Mat2 edges;
    edges << f[1] - f[0], f[2] - f[0];
    const Vec2 st = edges.inverse() * (at - f[0]);
    const std::array<double, 3> weights = {1 - st.x() - st.y(), st.x(), st.y()};
    const double least = *std::min_element(weights.begin(), weights.end());
    if (least <= inside) continue;
    inside = least;
    best = PanelPoint{t, weights};
  }
  return best;
}

Vec3 position(const Cloth& cloth, const PanelPoint& p) {
  Vec3 x = Vec3::Zero();
  for (std::size_t c = 0; c < 3; ++c) x += p.weights[c] * cloth.x[cloth.triangles[p.triangle][c]];
  return x;
}

double layer_spacing(const SolverOptions& solver, const Cloth& cloth, int panel) {
  if (solver.contact_distance > 0) return solver.contact_distance;
  const ClothPanel& p = cloth.panels[static_cast<std::size_t>(panel)];
  return default_contact_distance(cloth.fabrics[static_cast<std::size_t>(p.fabric)].thickness, p.edge_length);
}

}  // namespace toile
