#pragma once
// What the benchmarks work on: a sheet of about 10,000 vertices pressed onto a ball, or two of them one on the other.

#include "engine/contact/collision_mesh.h"
#include "engine/geometry/body_field.h"
#include "tests/engine/solve/sheets.h"

namespace toile::test {

struct SheetOnBall {
  static constexpr double kEdge = 0.01, kRadius = 0.5;  // [m]

  /// Bends a sheet of 1 m by 1 m onto the ball, its middle touching, `off` from the surface.
  static Vec3 bend(const Vec2& uv, double off) {
    const Vec2 from_middle = uv - Vec2(0.5, 0.5);
    const double arc = from_middle.norm(), angle = arc / kRadius, radius = kRadius + off;
    const Vec2 direction = arc > 0 ? Vec2(from_middle / arc) : Vec2(1, 0);
    return {radius * std::sin(angle) * direction.x(), radius * std::cos(angle),
            radius * std::sin(angle) * direction.y()};
  }

  explicit SheetOnBall(double off = 2e-3)
      : cloth(equilateral_sheet(100, 115, kEdge, suiting(), [&](const Vec2& uv) { return bend(uv, off); })),
        mesh(make_collision_mesh(cloth, 0)),
        ball(make_body_field({SphereBody{Vec3::Zero(), kRadius}, 0.3}, kEdge)) {}

  Cloth cloth;
  CollisionMesh mesh;
  BodyField ball;
};

/// A second sheet a millimetre above the first, as one cloth.
inline Cloth two_layers() {
  Cloth cloth = SheetOnBall(2e-3).cloth;
  const Cloth above = SheetOnBall(3e-3).cloth;
  const int first = static_cast<int>(cloth.x.size());
  cloth.x.insert(cloth.x.end(), above.x.begin(), above.x.end());
  for (Triangle t : above.triangles) cloth.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  cloth.flat.insert(cloth.flat.end(), above.flat.begin(), above.flat.end());
  cloth.triangle_panel.insert(cloth.triangle_panel.end(), above.triangle_panel.begin(), above.triangle_panel.end());
  cloth.vertex_garment.insert(cloth.vertex_garment.end(), above.x.size(), 1);
  return cloth;
}

}  // namespace toile::test
