#include "engine/quality/mesh_bending.h"

#include "engine/mesh/build_cloth.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

/// A square of right-angled cells: cut by one diagonal, or by both.
Cloth grid(int cells, bool both_diagonals) {
  Cloth cloth;
  std::vector<Vec2> flat;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) flat.emplace_back(0.01 * i, 0.01 * j);
  const auto add = [&](int a, int b, int c) {
    cloth.triangles.push_back({a, b, c});
    cloth.flat.push_back({flat[a], flat[b], flat[c]});
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, d = a + cells + 1, c = d + 1;
      if (both_diagonals) {
        const int m = static_cast<int>(flat.size());
        flat.emplace_back(0.01 * (i + 0.5), 0.01 * (j + 0.5));
        add(a, b, m), add(b, c, m), add(c, d, m), add(d, a, m);
      } else {
        add(a, b, c), add(a, c, d);
      }
    }
  for (const Vec2& p : flat) cloth.x.emplace_back(p.x(), p.y(), 0);
  cloth.triangle_panel.assign(cloth.triangles.size(), 0);
  cloth.panels.resize(1);
  cloth.panels[0].name = "grid";
  cloth.fabrics.resize(1);
  return cloth;
}

TEST(MeshBending, ThePanelMeshersMeshesBendRight) {
  const Cloth cloth = build_cloth(tube_scene(0.012));
  const MeshBending found = measure_mesh_bending(cloth, 0);
  std::printf("panel mesher: %.4f to %.4f\n", found.least, found.largest);
  EXPECT_GT(found.least, 0.99);
  EXPECT_LT(found.largest, 1.001);
}

TEST(MeshBending, GridsOfOneDiagonalDo) {
  const MeshBending found = measure_mesh_bending(grid(20, false), 0);
  EXPECT_GT(found.least, 0.99);
  EXPECT_LT(found.largest, 1.001);
}

TEST(MeshBending, FourTrianglesASquareBendTooEasilyAndAreWarnedOf) {
  Cloth cloth = grid(20, true);
  const MeshBending found = measure_mesh_bending(cloth, 0);
  std::printf("four triangles a square: %.4f to %.4f\n", found.least, found.largest);
  EXPECT_LT(found.least, 0.96);  // no form of six nodes reaches 1 (terms/bending_balance.h)
  EXPECT_GT(found.least, 0.92);
  EXPECT_LT(found.largest, 0.97);
  warn_of_mesh_bending(cloth, {0});
  EXPECT_TRUE(cloth.warnings.empty());
  warn_of_mesh_bending(cloth, {1});
  ASSERT_EQ(cloth.warnings.size(), 1u);
  EXPECT_EQ(cloth.warnings[0].rfind("mesh_bending: panel 'grid'", 0), 0u);
}

TEST(MeshBending, AMeshTooSmallToTellSaysNothing) {
  const MeshBending found = measure_mesh_bending(grid(2, true), 0);
  EXPECT_EQ(found.least, 1);
  EXPECT_EQ(found.largest, 1);
}

}  // namespace
}  // namespace toile
