#pragma once
// Flat sheets and fabrics for tests of the solver, near-equilateral as the panel mesher makes them.

#include "engine/mesh/cloth.h"

#include <cmath>

namespace toile::test {

inline Fabric isotropic_fabric(double density, double stretch, double shear, double poisson, double bending) {
  Fabric f;
  f.name = "test";
  f.area_density = density;
  f.stretch_stiffness = {stretch, stretch, shear};
  f.poisson_stiffness = poisson;
  f.bending_stiffness = {bending, bending, bending};
  f.thickness = 5e-4;
  return f;
}

/// A light suiting.
inline Fabric suiting() { return isotropic_fabric(0.2, 500, 50, 50, 5e-6); }

/// How a flat point (u weft, v warp) [m] lies in space at the start.
inline Vec3 lie_flat(const Vec2& uv) { return {uv.x(), 0, uv.y()}; }

/// Equilateral lattice on [0, columns · edge] × [0, rows · edge · √3/2]: rows of edges run along u; odd rows are
/// shifted by half an edge and closed with half triangles, so the outline is a rectangle. Vertices row by row.
template <class Place>
Cloth equilateral_sheet(int columns, int rows, double edge, const Fabric& fabric, const Place& place) {
  Cloth cloth;
  std::vector<Vec2> flat;
  std::vector<std::vector<int>> row_vertices(rows + 1);
  const double height = edge * std::sqrt(3.0) / 2;
  for (int r = 0; r <= rows; ++r) {
    const auto add = [&](double u) {
      row_vertices[r].push_back(static_cast<int>(flat.size()));
      flat.emplace_back(u, r * height);
    };
    if (r % 2 == 0) {
      for (int c = 0; c <= columns; ++c) add(c * edge);
    } else {
      add(0);
      for (int c = 0; c < columns; ++c) add((c + 0.5) * edge);
      add(columns * edge);
    }
  }
  const auto triangle = [&](int a, int b, int c) {
    cloth.triangles.push_back({a, b, c});
    cloth.flat.push_back({flat[a], flat[b], flat[c]});
  };
  for (int r = 0; r < rows; ++r) {
    const bool even_below = r % 2 == 0;
    const auto& even = row_vertices[even_below ? r : r + 1];
    const auto& odd = row_vertices[even_below ? r + 1 : r];
    for (int c = 0; c <= columns; ++c) {
      if (even_below)
        triangle(even[c], odd[c + 1], odd[c]);
      else
        triangle(even[c], odd[c], odd[c + 1]);
      if (c == columns) continue;
      if (even_below)
        triangle(even[c], even[c + 1], odd[c + 1]);
      else
        triangle(even[c], odd[c + 1], even[c + 1]);
    }
  }
  for (const Vec2& uv : flat) cloth.x.push_back(place(uv));
  cloth.triangle_panel.assign(cloth.triangles.size(), 0);
  cloth.vertex_garment.assign(cloth.x.size(), 0);
  ClothPanel panel;
  panel.name = "sheet";
  panel.edge_length = edge;
  cloth.panels = {panel};
  cloth.fabrics = {fabric};
  return cloth;
}

inline Cloth equilateral_sheet(int columns, int rows, double edge, const Fabric& fabric) {
  return equilateral_sheet(columns, rows, edge, fabric, lie_flat);
}

}  // namespace toile::test
