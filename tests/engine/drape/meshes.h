#pragma once
// Meshes as a file would bring them: a ball as a body, a tube of two grids as a garment.

#include "engine/scene/scene.h"

#include <numbers>

namespace toile::test {

/// Closed ball around the origin; rings of quads in two triangles and a fan at either pole.
inline TriangleMesh ball_mesh(double radius, int rings, int sectors) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, radius, 0});
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double polar = std::numbers::pi * r / rings, around = 2 * std::numbers::pi * s / sectors;
      mesh.vertices.push_back({radius * std::sin(polar) * std::sin(around), radius * std::cos(polar),
                               radius * std::sin(polar) * std::cos(around)});
    }
  mesh.vertices.push_back({0, -radius, 0});
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int r, int s) { return 1 + (r - 1) * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  return mesh;
}

/// Two grids, `off` in front of and behind the y axis, with their upright borders as pairs of vertices to be sewn.
inline GarmentMesh tube_mesh(double half_girth, double height, double off, int columns, int rows) {
  GarmentMesh shape;
  TriangleMesh& mesh = shape.mesh;
  mesh.group_names = {"front", "back"};
  const auto at = [&](int side, int r, int c) { return (side * (rows + 1) + r) * (columns + 1) + c; };
  for (int side = 0; side < 2; ++side) {
    const double turn = side == 0 ? 1 : -1;
    const auto flat = [&](int r, int c) {
      return Vec2(half_girth * (static_cast<double>(c) / columns - 0.5), height * r / rows);
    };
    for (int r = 0; r <= rows; ++r)
      for (int c = 0; c <= columns; ++c)
        mesh.vertices.push_back({turn * flat(r, c).x(), flat(r, c).y() - height / 2, turn * off});
    const auto add = [&](std::array<int, 2> p, std::array<int, 2> q, std::array<int, 2> o) {
      mesh.triangles.push_back({at(side, p[0], p[1]), at(side, q[0], q[1]), at(side, o[0], o[1])});
      mesh.corner_uv.push_back({flat(p[0], p[1]), flat(q[0], q[1]), flat(o[0], o[1])});
      mesh.triangle_group.push_back(side);
    };
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {  // diagonals alternate, so that bending has no preferred skew
        if ((r + c) % 2 == 0) {
          add({r, c}, {r, c + 1}, {r + 1, c + 1});
          add({r, c}, {r + 1, c + 1}, {r + 1, c});
        } else {
          add({r, c}, {r, c + 1}, {r + 1, c});
          add({r, c + 1}, {r + 1, c + 1}, {r + 1, c});
        }
      }
  }
  for (int r = 0; r <= rows; ++r) {
    shape.seams.emplace_back(at(0, r, columns), at(1, r, 0));
    shape.seams.emplace_back(at(0, r, 0), at(1, r, columns));
  }
  return shape;
}

}  // namespace toile::test
