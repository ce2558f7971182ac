#include "engine/mesh/build_cloth.h"
#include "engine/mesh/conforming_seams.h"
#include "engine/mesh/obj.h"
#include "engine/mesh/panel_mesher.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/topology.h"
#include "engine/scene/check.h"
#include "engine/scene/problem.h"
#include "tests/engine/mesh/real_patterns.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace toile {
namespace {

/// A strip of height 1 along x from 0 to `length`, `n` segments along, moved by `shift` in space; flat as at shift 0.
void add_strip(TriangleMesh& mesh, int n, double length, const Vec3& shift, int group) {
  const int base = static_cast<int>(mesh.vertices.size());
  const auto flat = [&](int i, int j) { return Vec2(length * i / n, j); };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j < 2; ++j) mesh.vertices.push_back(Vec3(flat(i, j).x(), flat(i, j).y(), 0) + shift);
  }
  for (int i = 0; i < n; ++i) {
    const int a = base + 2 * i;
    mesh.triangles.push_back({a, a + 2, a + 3});
    mesh.corner_uv.push_back({flat(i, 0), flat(i + 1, 0), flat(i + 1, 1)});
    mesh.triangles.push_back({a, a + 3, a + 1});
    mesh.corner_uv.push_back({flat(i, 0), flat(i + 1, 1), flat(i, 1)});
    mesh.triangle_group.insert(mesh.triangle_group.end(), 2, group);
  }
}

/// Lower strip's upper edge stitched to the upper strip's lower edge, which has another number of segments.
TriangleMesh two_strips(int lower, int upper) {
  TriangleMesh mesh;
  mesh.group_names = {"lower", "upper"};
  add_strip(mesh, lower, 10, Vec3::Zero(), 0);
  add_strip(mesh, upper, 10, Vec3(0, 1.5, 0), 1);
  const int base = 2 * (lower + 1);
  for (int i = 0; i <= lower; ++i) {
    const double at = static_cast<double>(i) * upper / lower;
    const int segment = std::min(upper - 1, static_cast<int>(at));
    mesh.stitches.push_back({2 * i + 1, base + 2 * segment, base + 2 * segment + 2, at - segment});
  }
  return mesh;
}

double flat_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& uv : mesh.corner_uv) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

Scene scene_with(TriangleMesh mesh) {
  Scene scene;
  scene.garments.emplace_back();
  scene.garments[0].name = "dress";
  scene.garments[0].shape = GarmentMesh{std::move(mesh), 1.0, {}};
  return scene;
}

TEST(ConformingSeams, StripsOfAnyCountsCloseToOneSheet) {
  for (const auto& [lower, upper] :
       std::vector<std::pair<int, int>>{{10, 10}, {10, 11}, {11, 10}, {7, 23}, {23, 7}, {1, 9}, {9, 1}, {40, 43}}) {
    SCOPED_TRACE(std::to_string(lower) + " on " + std::to_string(upper));
    TriangleMesh mesh = two_strips(lower, upper);
    const double area = flat_area(mesh);
    conform_stitches(mesh, "");
    EXPECT_NEAR(flat_area(mesh), area, 1e-12);
    Cloth cloth = build_cloth(scene_with(two_strips(lower, upper)));
    EXPECT_NEAR(seam_gap_max(cloth), 0.5, 0.3 * 10 / std::min(lower, upper));
    const std::size_t triangles = cloth.triangles.size();
    merge_seams(cloth);
    EXPECT_EQ(cloth.triangles.size(), triangles) << "no triangle collapses";
    EXPECT_TRUE(non_manifold_edges(cloth.triangles).empty());
    EXPECT_EQ(boundary_loops(cloth.triangles).size(), 1U);
    EXPECT_EQ(euler_characteristic(cloth.triangles), 1);
  }
}

TEST(ConformingSeams, SnapsInsteadOfSplittingCloseBy) {
  TriangleMesh mesh = two_strips(10, 10);
  for (std::size_t s = 1; s + 1 < mesh.stitches.size(); ++s) mesh.stitches[s].t = s % 2 ? 0.2 : 0.0;
  const std::size_t vertices = mesh.vertices.size();
  const auto pairs = conform_stitches(mesh, "");
  EXPECT_EQ(mesh.vertices.size(), vertices);
  EXPECT_EQ(pairs.size(), 11U);
  EXPECT_TRUE(mesh.stitches.empty());
}

TEST(ConformingSeams, RefusesAStitchOnNoEdge) {
  TriangleMesh mesh = two_strips(4, 4);
  mesh.stitches[2].to = 0;
  mesh.stitches[2].t = 0.5;
  try {
    conform_stitches(mesh, "/garments/0/mesh");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "unknown_edge");
  }
}

TEST(GarmentMesh, SeamsAsPairsUnitsAndGroups) {
  TriangleMesh mesh = two_strips(5, 5);
  mesh.stitches.clear();
  mesh.vertices.emplace_back(9, 9, 9);  // in no triangle
  Scene scene = scene_with(mesh);
  auto& shape = std::get<GarmentMesh>(scene.garments[0].shape);
  shape.uv_unit = 0.1;
  for (int i = 0; i <= 5; ++i) shape.seams.emplace_back(2 * i + 1, 12 + 2 * i);
  scene.garments[0].panel_fabrics["upper"].name = "lace";
  Cloth cloth = build_cloth(scene);
  EXPECT_EQ(cloth.x.size(), 24U);
  EXPECT_EQ(cloth.panels[1].name, "upper");
  EXPECT_EQ(cloth.fabrics[static_cast<std::size_t>(cloth.panels[1].fabric)].name, "lace");
  EXPECT_NEAR(cloth.flat[0][1].x(), 0.2, 1e-12);
  EXPECT_EQ(cloth.seam_pairs.size(), 6U);
  EXPECT_FALSE(cloth.warnings.empty()) << "the unused vertex";
  merge_seams(cloth);
  EXPECT_EQ(boundary_loops(cloth.triangles).size(), 1U);
}

TEST(GarmentMesh, CollapsedTrianglesAreDroppedWithAWarning) {
  TriangleMesh mesh = two_strips(3, 3);
  mesh.stitches.clear();
  Scene scene = scene_with(mesh);
  std::get<GarmentMesh>(scene.garments[0].shape).seams = {{0, 2}};
  Cloth cloth = build_cloth(scene);
  const std::size_t before = cloth.triangles.size();
  merge_seams(cloth);
  EXPECT_EQ(cloth.triangles.size(), before - 1);
  EXPECT_EQ(cloth.flat.size(), cloth.triangles.size());
  EXPECT_EQ(cloth.triangle_panel.size(), cloth.triangles.size());
  EXPECT_THAT(cloth.warnings.back(), testing::HasSubstr("collapsed_triangles: 1 "));
}

TEST(GarmentMesh, CipcDressCloses) {
  const auto path = kShared / "cipc" / "dress_knife_stage.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path;
  const TriangleMesh mesh = read_obj(file_bytes(path));
  EXPECT_EQ(mesh.vertices.size(), 15656U);
  EXPECT_EQ(mesh.triangles.size(), 29456U);
  EXPECT_EQ(mesh.stitches.size(), 851U);
  EXPECT_EQ(mesh.group_names.size(), 14U);
  Cloth cloth = build_cloth(scene_with(mesh));
  std::printf("dress: %zu vertices, %zu triangles, %zu pairs (851 stitches), %zu inserted, gap %.1f mm\n",
              cloth.x.size(), cloth.triangles.size(), cloth.seam_pairs.size(), cloth.x.size() - mesh.vertices.size(),
              1e3 * seam_gap_max(cloth));
  double given = 180;
  for (const auto& uv : mesh.corner_uv) given = std::min(given, 180 / M_PI * smallest_angle(uv[0], uv[1], uv[2]));
  std::vector<double> angles;
  for (const auto& flat : cloth.flat) angles.push_back(180 / M_PI * smallest_angle(flat[0], flat[1], flat[2]));
  std::sort(angles.begin(), angles.end());
  std::printf("smallest angles: given %.1f, min %.1f, 0.1%% %.1f, 1%% %.1f\n", given, angles[0],
              angles[angles.size() / 1000], angles[angles.size() / 100]);
  const std::size_t triangles = cloth.triangles.size();
  merge_seams(cloth);
  EXPECT_LE(triangles - cloth.triangles.size(), 30U) << "slivers and the tips of pleats";
  const std::vector<int> component = connected_components(cloth.triangles);
  const auto crowded = non_manifold_edges(cloth.triangles);
  const auto loops = boundary_loops(cloth.triangles);
  std::printf("merged: %zu vertices, %d components, %zu non-manifold edges, Euler %ld, %zu boundary loops:",
              cloth.x.size(), 1 + *std::max_element(component.begin(), component.end()), crowded.size(),
              euler_characteristic(cloth.triangles), loops.size());
  for (const auto& loop : loops) {
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      length +=
          (cloth.x[static_cast<std::size_t>(loop[i])] - cloth.x[static_cast<std::size_t>(loop[(i + 1) % loop.size()])])
              .norm();
    }
    std::printf(" %zu (%.0f mm)", loop.size(), 1e3 * length);
  }
  std::printf("\n");
  EXPECT_EQ(*std::max_element(component.begin(), component.end()), 0);
  // Neckline, hem and two armholes; the knife pleats join three layers along the waist.
  EXPECT_EQ(std::count_if(loops.begin(), loops.end(), [](const auto& loop) { return loop.size() > 20; }), 4);
  EXPECT_LT(crowded.size(), 80U);
}

}  // namespace
}  // namespace toile
