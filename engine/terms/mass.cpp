#include "engine/terms/mass.h"

#include <cmath>

namespace toile {

std::vector<double> lumped_masses(const Cloth& cloth) {
  std::vector<double> mass(cloth.x.size(), 0.0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const auto& flat = cloth.flat[t];
    const Vec2 a = flat[1] - flat[0], b = flat[2] - flat[0];
    const double area = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    const double density = cloth.fabrics.at(cloth.panels.at(cloth.triangle_panel[t]).fabric).area_density;
    for (int node : cloth.triangles[t]) mass[node] += density * area / 3;
  }
  return mass;
}

}  // namespace toile
