#include "engine/terms/mass.h"

#include "engine/geometry/flat_triangle.h"

namespace toile {

std::vector<double> lumped_masses(const Cloth& cloth) {
  std::vector<double> mass(cloth.x.size(), 0.0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
    const double area = flat_area(cloth.flat[t]);
    const double density = cloth.fabrics.at(cloth.panels.at(cloth.triangle_panel[t]).fabric).area_density;
    for (int node : cloth.triangles[t]) mass[node] += density * area / 3;
  }
  return mass;
}

}  // namespace toile
