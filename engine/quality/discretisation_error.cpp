#include "engine/quality/discretisation_error.h"

#include "engine/geometry/dihedral.h"
#include "engine/geometry/flat_triangle.h"
#include "engine/mesh/topology.h"
#include "engine/terms/contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile {
namespace {

/// Of the edge v0–v1, in the flat pattern of a triangle that has it.
Vec2 flat_edge(const Cloth& cloth, int triangle, int v0, int v1) {
  const auto at = [&](int vertex) {
    const Triangle& corners = cloth.triangles[triangle];
    return cloth.flat[triangle][std::find(corners.begin(), corners.end() - 1, vertex) - corners.begin()];
  };
  return at(v1) - at(v0);
}

struct Curvature {
  Mat2 tensor = Mat2::Zero();  // times the triangle's area
  int hinges = 0;
};

std::vector<Curvature> curvatures(const Cloth& cloth) {
  std::vector<Curvature> curvature(cloth.triangles.size());
  for (const Hinge& h : hinges(cloth.triangles)) {
    const double angle = dihedral_angle(cloth.x[h.v0], cloth.x[h.v1], cloth.x[h.v2], cloth.x[h.v3]);
    for (const int t : {h.triangle_a, h.triangle_b}) {
      const Vec2 edge = flat_edge(cloth, t, h.v0, h.v1), normal = Vec2(-edge.y(), edge.x());
      if (edge.norm() > 0) curvature[t].tensor += 0.5 * angle / edge.norm() * normal * normal.transpose();
      ++curvature[t].hinges;
    }
  }
  return curvature;
}

double shape_error(const Cloth& cloth, const std::vector<double>& area, double total) {
  constexpr double kChord = 1.0 / 16;
  const std::vector<Curvature> curvature = curvatures(cloth);
  double sum = 0;
  for (std::size_t t = 0; t < area.size(); ++t) {
    const double h = std::sqrt(4 / std::numbers::sqrt3 * area[t]);
    const double length = bending_length(cloth.fabrics[cloth.panels[cloth.triangle_panel[t]].fabric]);
    const Mat2& tensor = curvature[t].tensor;
    sum += kChord * h * h * tensor.norm();
    // Along a free edge a hinge is missing, which alone would show as curvature in two directions.
    if (curvature[t].hinges == 3)
      sum += kFoldErrorFactor * h * std::max(h, length) * std::sqrt(std::abs(tensor.determinant()));
  }
  return sum / total;
}

double offset_error(const Cloth& cloth, const std::vector<double>& area, double total,
                    std::span<const Contact> body_contacts) {
  std::vector<double> share(cloth.x.size(), 0.0), half_thickness(cloth.x.size(), 0.0);
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int v : cloth.triangles[t]) {
      share[v] += area[t] / (3 * total);
      half_thickness[v] = 0.5 * cloth.fabrics[cloth.panels[cloth.triangle_panel[t]].fabric].thickness;
    }
  double sum = 0;
  for (const Contact& c : body_contacts) {
    if (c.count != 1 || contact_gap(c, cloth.x) >= c.distance) continue;
    sum += share[c.nodes[0]] * std::max(0.0, c.distance - half_thickness[c.nodes[0]]);
  }
  return sum;
}

}  // namespace

double discretisation_error(const Cloth& cloth, std::span<const Contact> body_contacts) {
  std::vector<double> area;
  double total = 0;
  for (const std::array<Vec2, 3>& corner : cloth.flat) total += area.emplace_back(flat_area(corner));
  if (!(total > 0)) return 0;
  return shape_error(cloth, area, total) + offset_error(cloth, area, total, body_contacts);
}

}  // namespace toile
