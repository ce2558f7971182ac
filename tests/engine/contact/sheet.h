#pragma once
// A flat equilateral sheet as simulation mesh, for tests of contact and of position-based moves.

#include "engine/mesh/cloth.h"

#include <cmath>

namespace toile::test {

/// Rows × columns vertices in the x–z plane at height y, rows `edge`·√3/2 apart, odd rows shifted by half an edge.
inline void add_sheet(Cloth& cloth, int rows, int columns, double edge, double y, double shift_x = 0) {
  const int first = static_cast<int>(cloth.x.size());
  if (cloth.panels.empty()) {
    Fabric fabric;
    fabric.area_density = 0.2;
    fabric.thickness = 1e-3;
    fabric.friction_cloth = 0.3;
    fabric.stretch_stiffness = {500, 500, 100};
    fabric.bending_stiffness = {1e-5, 1e-5, 1e-5};
    cloth.fabrics.push_back(fabric);
    cloth.panels.push_back({0, "sheet", "", 0, edge});
  }
  const auto flat = [&](int r, int c) { return Vec2((c + 0.5 * (r % 2)) * edge, r * edge * std::sqrt(0.75)); };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const Vec2 p = flat(r, c);
      cloth.x.push_back({p.x() + shift_x, y, p.y()});
      cloth.vertex_garment.push_back(0);
    }
  const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
    const auto index = [&](std::array<int, 2> v) { return first + v[0] * columns + v[1]; };
    cloth.triangles.push_back({index(a), index(b), index(c)});
    cloth.flat.push_back({flat(a[0], a[1]), flat(b[0], b[1]), flat(c[0], c[1])});
    cloth.triangle_panel.push_back(0);
  };
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      if (r % 2 == 0) {
        add({r, c}, {r + 1, c}, {r, c + 1});
        add({r, c + 1}, {r + 1, c}, {r + 1, c + 1});
      } else {
        add({r, c}, {r + 1, c}, {r + 1, c + 1});
        add({r, c}, {r + 1, c + 1}, {r, c + 1});
      }
    }
}

}  // namespace toile::test
