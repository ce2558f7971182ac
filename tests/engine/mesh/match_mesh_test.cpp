#include "engine/mesh/match_mesh.h"

#include "engine/mesh/build_cloth.h"
#include "engine/mesh/sewing.h"
#include "engine/scene/problem.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace toile {
namespace {

/// Two squares of two triangles, side by side, 1 m wide, whose facing sides a seam joins.
Cloth two_squares() {
  Cloth cloth;
  for (int panel = 0; panel < 2; ++panel) {
    const int first = 4 * panel;
    const std::vector<Vec2> flat{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    for (const Vec2& p : flat) cloth.x.push_back({p.x() + 1.5 * panel, p.y(), 0});
    for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}}) {
      cloth.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      cloth.flat.push_back({flat[t[0]], flat[t[1]], flat[t[2]]});
      cloth.triangle_panel.push_back(panel);
    }
    ClothPanel named;
    named.name = panel == 0 ? "left" : "right";
    cloth.panels.push_back(named);
  }
  cloth.vertex_garment.assign(8, 0);
  cloth.fabrics.resize(1);
  cloth.seam_pairs = {{1, 4, 0}, {2, 7, 0}};
  cloth.seam_names = {"seam"};
  return cloth;
}

Cloth sewn_squares() {
  Cloth cloth = two_squares();
  merge_seams(cloth);
  return cloth;
}

TEST(MatchMesh, TheSewnGarmentKeepsItsVerticesWhateverTheOrderOfTriangles) {
  TriangleMesh mesh = surface_mesh(sewn_squares());
  for (Vec3& p : mesh.vertices) p += Vec3(p.y(), 2, 3);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  const MatchedCloth matched = match_mesh(two_squares(), mesh);
  EXPECT_EQ(matched.cloth.x, mesh.vertices);
  EXPECT_EQ(matched.cloth.triangles, sewn_squares().triangles);
  EXPECT_TRUE(matched.cloth.seam_pairs.empty());
  EXPECT_EQ(matched.seam_gap_max, 0);
}

TEST(MatchMesh, SidesOfASeamMeetInTheirMeanAndTheirGapIsTold) {
  const Cloth apart = two_squares();
  const MatchedCloth matched = match_mesh(apart, surface_mesh(apart));
  EXPECT_DOUBLE_EQ(matched.seam_gap_max, 0.5);
  EXPECT_EQ(matched.cloth.x.size(), 6U);
  EXPECT_EQ(matched.cloth.x[1], Vec3(1.25, 0, 0));
}

TEST(MatchMesh, RepeatedVerticesAreFoundByTheirCorners) {
  const TriangleMesh sewn = surface_mesh(sewn_squares());
  TriangleMesh soup;
  for (std::size_t t = 0; t < sewn.triangles.size(); ++t) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int v : sewn.triangles[t]) soup.vertices.push_back(sewn.vertices[v] + Vec3(0, 0, 1));
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.corner_uv.push_back(sewn.corner_uv[t]);
    for (Vec2& uv : soup.corner_uv.back()) uv *= 1000;  // millimetres
  }
  const MatchedCloth matched = match_mesh(two_squares(), soup);
  EXPECT_EQ(matched.seam_gap_max, 0);
  for (std::size_t v = 0; v < matched.cloth.x.size(); ++v)
    EXPECT_LT((matched.cloth.x[v] - sewn.vertices[v] - Vec3(0, 0, 1)).norm(), 1e-15);

  std::swap(soup.corner_uv[0], soup.corner_uv[1]);  // as many triangles, but not those of the pattern
  EXPECT_THROW(match_mesh(two_squares(), soup), InputError);
}

TEST(MatchMesh, TheBodyOfARunsGlbIsLeftOut) {
  TriangleMesh mesh = surface_mesh(sewn_squares());
  mesh.group_names = {"garment", "body"};
  mesh.triangle_group.assign(mesh.triangles.size(), 0);
  mesh.vertices.insert(mesh.vertices.end(), {Vec3(9, 0, 0), Vec3(9, 1, 0), Vec3(9, 0, 1)});
  mesh.triangles.push_back({6, 7, 8});
  mesh.corner_uv.push_back({Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)});
  mesh.triangle_group.push_back(1);
  const MatchedCloth matched = match_mesh(two_squares(), mesh);
  EXPECT_EQ(matched.cloth.x, sewn_squares().x);
}

TEST(MatchMesh, RefusesAnotherMeshAndSaysHowTheyDiffer) {
  TriangleMesh mesh = surface_mesh(sewn_squares());
  mesh.vertices.push_back({5, 5, 5});
  mesh.triangles.push_back({0, 1, 6});
  mesh.corner_uv.push_back({Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)});
  try {
    match_mesh(two_squares(), mesh);
    ADD_FAILURE() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "mesh_mismatch");
    for (const char* count : {"7 vertices and 5 triangles", "8 vertices and 4 triangles", "6 vertices and 4 triangles"})
      EXPECT_NE(error.problems()[0].detail.find(count), std::string::npos) << count;
  }
}

}  // namespace
}  // namespace toile
