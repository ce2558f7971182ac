#include "engine/contact/collision_mesh.h"

#include "tests/engine/contact/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace toile {
namespace {

using test::add_sheet;

TEST(ContactDistance, FollowsTheEdgeAndIsNeverThinnerThanTheFabric) {
  EXPECT_DOUBLE_EQ(default_contact_distance(5e-4, 0.01), 1.8e-3);
  EXPECT_DOUBLE_EQ(default_contact_distance(5e-4, 0.05), 3e-3);
  EXPECT_DOUBLE_EQ(default_contact_distance(8e-3, 0.05), 8e-3);
  EXPECT_DOUBLE_EQ(default_contact_distance(0, 0.001), 1.8e-4);
}

TEST(CollisionMesh, EdgesAreUniqueAndCoverEveryTriangle) {
  Cloth cloth;
  add_sheet(cloth, 5, 6, 0.015, 0);
  const CollisionMesh mesh = make_collision_mesh(cloth, 0);
  EXPECT_EQ(mesh.triangles, cloth.triangles);
  const std::set<std::array<int, 2>> edges(mesh.edges.begin(), mesh.edges.end());
  EXPECT_EQ(edges.size(), mesh.edges.size());
  EXPECT_EQ(
      static_cast<long>(cloth.x.size()) - static_cast<long>(edges.size()) + static_cast<long>(cloth.triangles.size()),
      1);  // Euler: a disc
  for (const Triangle& t : cloth.triangles)
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(edges.count({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}));
}

TEST(CollisionMesh, DistanceAndFrictionComeFromTheFabric) {
  Cloth cloth;
  add_sheet(cloth, 5, 6, 0.015, 0);
  const CollisionMesh own = make_collision_mesh(cloth, 0), wanted = make_collision_mesh(cloth, 1e-3);
  for (std::size_t v = 0; v < cloth.x.size(); ++v) {
    const int self[] = {static_cast<int>(v)};
    EXPECT_DOUBLE_EQ(own.pair_distance(self, self), 0.18 * 0.015);
    EXPECT_DOUBLE_EQ(wanted.pair_distance(self, self), 1e-3);
    EXPECT_DOUBLE_EQ(own.pair_friction(self, self), 0.3);
  }
}

TEST(CollisionMesh, SmallTrianglesShrinkTheDistanceAroundThem) {
  Cloth cloth;
  add_sheet(cloth, 5, 6, 0.015, 0);
  // One triangle drawn a tenth as tall: its altitude bounds the distance of its own vertices only.
  cloth.flat[0] = {Vec2(0, 0), Vec2(0.015, 0), Vec2(0.0075, 0.0013)};
  const auto distances = [&](double wanted) {
    const CollisionMesh mesh = make_collision_mesh(cloth, wanted);
    std::vector<double> list;
    for (int v = 0; v < static_cast<int>(cloth.x.size()); ++v) list.push_back(mesh.pair_distance({&v, 1}, {&v, 1}));
    return list;
  };
  const std::vector<double> own = distances(0);
  for (int v : cloth.triangles[0]) EXPECT_NEAR(own[v], 0.3 * 0.0013, 1e-12);
  EXPECT_EQ(std::count_if(own.begin(), own.end(), [](double d) { return d < 2e-3; }), 3);
  for (double d : distances(5e-3)) EXPECT_LE(d, 5e-3);
}

TEST(CollisionMesh, TwoFabricsTakeHalfTheSumOfWhatBothWant) {
  Cloth cloth;
  add_sheet(cloth, 5, 6, 0.01, 0);
  const int first = 0, second = static_cast<int>(cloth.x.size());
  const std::size_t triangles = cloth.triangles.size();
  add_sheet(cloth, 5, 6, 0.01, 0.005);
  cloth.fabrics.push_back(cloth.fabrics[0]);
  cloth.fabrics[1].thickness = 2.4e-3;
  cloth.fabrics[1].friction_cloth = 0.5;
  cloth.panels.push_back(cloth.panels[0]);
  cloth.panels[1].fabric = 1;
  for (std::size_t t = triangles; t < cloth.triangles.size(); ++t) cloth.triangle_panel[t] = 1;
  const CollisionMesh mesh = make_collision_mesh(cloth, 0);
  const std::span<const int> a(&first, 1), b(&second, 1);
  EXPECT_NEAR(mesh.pair_distance(a, a), 1.8e-3, 1e-12) << "0.18 edges: more than the thickness";
  EXPECT_NEAR(mesh.pair_distance(b, b), 2.4e-3, 1e-12);
  EXPECT_NEAR(mesh.pair_distance(a, b), 2.1e-3, 1e-12);
  EXPECT_NEAR(mesh.pair_friction(a, b), 0.4, 1e-12);
  EXPECT_NEAR(mesh.body_offset[first], 1e-3, 1e-12);
  EXPECT_NEAR(mesh.body_offset[second], 1.2e-3, 1e-12);
}

Cloth two_sewn_sheets() {
  Cloth cloth;
  add_sheet(cloth, 6, 6, 0.015, 0);
  const std::size_t triangles = cloth.triangles.size();
  add_sheet(cloth, 6, 6, 0.015, 0, 0.2);
  cloth.panels.push_back(cloth.panels[0]);
  for (std::size_t t = triangles; t < cloth.triangles.size(); ++t) cloth.triangle_panel[t] = 1;
  for (int r = 0; r < 6; ++r) cloth.seam_pairs.push_back({r * 6 + 5, 36 + r * 6, 0});
  cloth.seam_names = {"seam"};
  return cloth;
}

TEST(CollisionMesh, SeamPartnersHaveOneIdentity) {
  const Cloth cloth = two_sewn_sheets();
  const CollisionMesh mesh = make_collision_mesh(cloth, 0);
  for (const SeamPair& pair : cloth.seam_pairs) EXPECT_EQ(mesh.identity[pair.a], mesh.identity[pair.b]);
  const std::set<int> identities(mesh.identity.begin(), mesh.identity.end());
  EXPECT_EQ(identities.size(), cloth.x.size() - cloth.seam_pairs.size());
  EXPECT_TRUE(mesh.seam_zone.empty());
}

TEST(CollisionMesh, ZonesReachAsManyEdgesFromTheSeamAsAskedFor) {
  const Cloth cloth = two_sewn_sheets();
  for (int reach : {1, 3}) {
    const CollisionMesh mesh = make_collision_mesh(cloth, 0, {{reach, false}});
    ASSERT_EQ(mesh.seam_zone.size(), cloth.x.size());
    ASSERT_EQ(mesh.panel.size(), cloth.x.size());
    for (std::size_t v = 0; v < cloth.x.size(); ++v) {
      const int column = static_cast<int>(v % 36) % 6, edges_away = v < 36 ? 5 - column : column;
      EXPECT_EQ(!mesh.seam_zone[v].empty(), edges_away <= reach) << v;
      EXPECT_TRUE(std::is_sorted(mesh.seam_zone[v].begin(), mesh.seam_zone[v].end()));
      EXPECT_EQ(mesh.panel[v], v < 36 ? 0 : 1);
    }
  }
}

TEST(CollisionMesh, ZonesWithinAPanelHaveNumbersOfTheirOwn) {
  const Cloth cloth = two_sewn_sheets();
  const CollisionMesh mesh = make_collision_mesh(cloth, 0, {{1, false}, {2, true}});
  for (std::size_t v = 0; v < cloth.x.size(); ++v) {
    const int column = static_cast<int>(v % 36) % 6, edges_away = v < 36 ? 5 - column : column;
    const auto negative = [](int zone) { return zone < -1; };
    EXPECT_EQ(std::any_of(mesh.seam_zone[v].begin(), mesh.seam_zone[v].end(), negative), edges_away <= 2) << v;
    EXPECT_EQ(std::all_of(mesh.seam_zone[v].begin(), mesh.seam_zone[v].end(), negative), edges_away > 1) << v;
  }
}

TEST(CollisionMesh, ZonesOnlyWhereASeamIsWiderThanAskedFor) {
  Cloth cloth = two_sewn_sheets();
  const SeamPair& closed = cloth.seam_pairs[0];
  cloth.x[closed.b] = cloth.x[closed.a];
  const CollisionMesh mesh = make_collision_mesh(cloth, 0, {{0, true, 1e-3}});
  EXPECT_TRUE(mesh.seam_zone[closed.a].empty());
  for (std::size_t k = 1; k < cloth.seam_pairs.size(); ++k) EXPECT_EQ(mesh.seam_zone[cloth.seam_pairs[k].a].size(), 1U);
}

}  // namespace
}  // namespace toile
