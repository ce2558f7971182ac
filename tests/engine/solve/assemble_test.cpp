#include "engine/solve/assemble.h"
#include "engine/solve/pin_motion.h"

#include "engine/mesh/sewing.h"
#include "engine/parallel/state_hash.h"
#include "engine/parallel/thread_limit.h"
#include "engine/scene/problem.h"
#include "tests/engine/geometry/mesh_samples.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <optional>

namespace toile {
namespace {

using namespace test;

struct Sewn {
  std::optional<BodyField> body;
  Assembly assembly;
  const Cloth& cloth() const { return assembly.cloth; }
};

Sewn sew(const Scene& scene, const BodyField* for_legs = nullptr) {
  Sewn sewn;
  if (scene.body) sewn.body = make_body_field(*scene.body, scene.garments[0].edge_length);
  const BodyFields fields{sewn.body ? &*sewn.body : nullptr, nullptr, for_legs};
  sewn.assembly = assemble(scene, build_cloth(scene), fields, [](const AssemblyState&) { return true; });
  return sewn;
}

/// What every assembly promises.
void expect_sound(const Sewn& sewn, double depth = 1e-3) {
  const Cloth& cloth = sewn.cloth();
  EXPECT_TRUE(sewn.assembly.open_seams.empty());
  EXPECT_LT(sewn.assembly.seam_gap_max, 1e-3);
  EXPECT_TRUE(cloth.seam_pairs.empty());
  EXPECT_EQ(sewn.assembly.crossings, 0u);
  EXPECT_EQ(self_intersections(cloth.x, cloth.triangles).size(), 0u);
  EXPECT_TRUE(all_finite(cloth.x));
  EXPECT_TRUE(non_manifold_edges(cloth.triangles).empty());
  if (!sewn.body) return;
  for (const Vec3& p : cloth.x) EXPECT_GT(sewn.body->distance(p), 0);
  EXPECT_LT(deepest_penetration(*sewn.body, cloth.x, cloth.triangles).depth, depth);
}

double largest_edge_stretch(const Cloth& cloth) {
  double worst = 0;
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, (cloth.x[cloth.triangles[t][(k + 1) % 3]] - cloth.x[cloth.triangles[t][k]]).norm() /
                                      (cloth.flat[t][(k + 1) % 3] - cloth.flat[t][k]).norm() -
                                  1);
  return worst;
}

TEST(Assemble, TwoPanelsBecomeATubeAroundACylinder) {
  const Scene scene = tube_scene(0.02);
  const std::size_t apart = build_cloth(scene).x.size(), pairs = build_cloth(scene).seam_pairs.size();
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  EXPECT_EQ(sewn.cloth().x.size(), apart - pairs);
  EXPECT_EQ(boundary_loops(sewn.cloth().triangles).size(), 2u);
  EXPECT_EQ(euler_characteristic(sewn.cloth().triangles), 0);
  EXPECT_LT(largest_edge_stretch(sewn.cloth()), 0.1);
  EXPECT_GT(sewn.assembly.steps, 0);
  // The body is inside the tube: the cloth goes all the way round it.
  std::vector<char> sector(12, 0);
  for (const Vec3& p : sewn.cloth().x)
    sector[static_cast<int>((std::atan2(p.x(), p.z()) / (2 * std::numbers::pi) + 0.5) * 12) % 12] = 1;
  EXPECT_EQ(std::count(sector.begin(), sector.end(), 1), 12);
}

TEST(Assemble, ATrouserLegThatReachesTheFloorEndsOverTheFoot) {
  Scene scene;
  // Wider than the foot is broad, tighter than the foot is long; it starts in front of the toes and below the sole.
  scene.garments = {garment_of(tube_pattern(0.27, 0.4, 0.25, -0.03), 0.02)};
  for (Panel& panel : std::get<Pattern>(scene.garments[0].shape).panels) {
    panel.label = "leg";
    panel.edges[2].label = "waist";
  }
  scene.garments[0].pins = {{PinLabel{"waist"}, PinAttached{}}};
  scene.body = Body{MeshBody{samples::joined(samples::box_mesh({0, 0.5, 0}, {0.05, 0.5, 0.05}),
                                             samples::box_mesh({0, 0.025, 0.08}, {0.05, 0.025, 0.13}))},
                    0.3};
  const BodyField pointed = make_body_field(*scene.body, 0.02).with_pointed_toes();
  const Sewn sewn = sew(scene, &pointed);
  expect_sound(sewn, 3e-3);  // the box's corners lie between vertices
  EXPECT_LT(largest_edge_stretch(sewn.cloth()), 0.1);
  bool around = false;
  for (const Vec3& p : sewn.cloth().x) {
    const bool over_foot = std::abs(p.x()) < 0.05 && p.z() > 0.05 && p.z() < 0.21;
    EXPECT_TRUE(!over_foot || p.y() > 0.05) << p.transpose();
    around = around || p.z() < -0.05;
  }
  EXPECT_TRUE(around);
}

TEST(Assemble, OldToNewFollowsEveryVertex) {
  const Scene scene = tube_scene();
  const Cloth apart = build_cloth(scene);
  const Sewn sewn = sew(scene);
  ASSERT_EQ(sewn.assembly.old_to_new.size(), apart.x.size());
  for (int v : sewn.assembly.old_to_new) ASSERT_LT(v, static_cast<int>(sewn.cloth().x.size()));
  for (const SeamPair& pair : apart.seam_pairs)
    EXPECT_EQ(sewn.assembly.old_to_new[pair.a], sewn.assembly.old_to_new[pair.b]);
  for (std::size_t t = 0; t < apart.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(sewn.assembly.old_to_new[apart.triangles[t][k]], sewn.cloth().triangles[t][k]);
}

TEST(Assemble, SameBytesOnAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    const ThreadLimit limit(threads);
    return sha256_hex(sew(tube_scene()).cloth().x);
  };
  const std::string one = hash(1);
  EXPECT_EQ(one, hash(2));
  EXPECT_EQ(one, hash(2));
}

TEST(Assemble, APanelThatStartsInsideTheBodyIsMovedOutAndSewn) {
  Scene scene = tube_scene();
  std::get<Pattern>(scene.garments[0].shape).panels[0].translation.z() = 0.05;
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  ASSERT_FALSE(sewn.cloth().warnings.empty());
  EXPECT_NE(sewn.cloth().warnings[0].find("front"), std::string::npos);
}

TEST(Assemble, APanelWhollyInsideAHugeBodyIsRefused) {
  Scene scene = tube_scene();
  scene.body = Body{SphereBody{Vec3::Zero(), 2.0}, 0.3};
  try {
    sew(scene);
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "panel_inside_body");
  }
}

TEST(Assemble, APanelWithoutSeamsWhollyInsideAHugeBodyIsRefused) {
  Scene scene;
  scene.garments = {square_garment(0.2, 0.05, 0)};
  scene.body = Body{SphereBody{Vec3::Zero(), 2.0}, 0.3};
  try {
    sew(scene);
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "panel_inside_body");
  }
}

TEST(Assemble, GathersSpreadTheLongerEdgeEvenly) {
  Scene scene = tube_scene(0.025);
  auto& pattern = std::get<Pattern>(scene.garments[0].shape);
  pattern.panels[0] = around_axis(rectangle_panel("front", 0.36, 0.225), 0, 0.16, -0.1375);  // 1.5 : 1
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  EXPECT_EQ(boundary_loops(sewn.cloth().triangles).size(), 2u);
}

TEST(Assemble, ADartClosesIntoAPoint) {
  Scene scene;
  Panel panel;
  panel.name = "darted";
  panel.vertices = {{-0.1, 0}, {0.1, 0}, {0.1, 0.2}, {0.02, 0.2}, {0, 0.1}, {-0.02, 0.2}, {-0.1, 0.2}};
  for (int k = 0; k < 7; ++k) panel.edges.push_back({k, (k + 1) % 7, StraightEdge{}, ""});
  scene.garments = {garment_of(Pattern{{panel}, {{{0, 3}, {0, 4}, false}}}, 0.02)};
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  EXPECT_EQ(boundary_loops(sewn.cloth().triangles).size(), 1u);
  EXPECT_EQ(euler_characteristic(sewn.cloth().triangles), 1);
}

TEST(Assemble, AGodetGoesIntoASlit) {
  Scene scene;
  Panel panel;
  panel.name = "slit";
  panel.vertices = {{-0.1, 0}, {0, 0}, {0, 0.12}, {0, 0}, {0.1, 0}, {0.1, 0.2}, {-0.1, 0.2}};
  panel.vertices[1].x() = -5e-4;  // a slit that is open by 1 mm at the hem
  panel.vertices[3].x() = 5e-4;
  for (int k = 0; k < 7; ++k) panel.edges.push_back({k, (k + 1) % 7, StraightEdge{}, ""});
  Panel godet;
  godet.name = "godet";
  godet.vertices = {{-0.04, 0}, {0.04, 0}, {0, 0.12}};
  for (int k = 0; k < 3; ++k) godet.edges.push_back({k, (k + 1) % 3, StraightEdge{}, ""});
  godet.translation.z() = 0.05;
  // The slit's left side runs up from the hem, its right side down to it; the godet's left side (2) runs down.
  scene.garments = {garment_of(Pattern{{panel, godet}, {{{0, 1}, {1, 2}, false}, {{0, 2}, {1, 1}, false}}}, 0.02)};
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  EXPECT_EQ(boundary_loops(sewn.cloth().triangles).size(), 1u);
  EXPECT_EQ(euler_characteristic(sewn.cloth().triangles), 1);
}

TEST(Assemble, TwoGarmentsEndInLayerOrder) {
  Scene scene;
  scene.garments = {garment_of(tube_pattern(0.345, 0.10, 0.15, -0.1), 0.03, "inner"),
                    garment_of(tube_pattern(0.40, 0.10, 0.20, -0.1), 0.03, "outer")};
  scene.body = cylinder_body();
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  const Cloth& cloth = sewn.cloth();
  ASSERT_EQ(boundary_loops(cloth.triangles).size(), 4u);
  // In every direction and at every height the outer garment is farther out.
  int compared = 0;
  for (std::size_t a = 0; a < cloth.x.size(); ++a)
    for (std::size_t b = 0; b < cloth.x.size(); ++b) {
      if (cloth.vertex_garment[a] != 0 || cloth.vertex_garment[b] != 1) continue;
      const Vec3 &inner = cloth.x[a], &outer = cloth.x[b];
      const double along = radius_of(inner) * std::abs(std::atan2(inner.x() * outer.z() - inner.z() * outer.x(),
                                                                  inner.x() * outer.x() + inner.z() * outer.z()));
      if (std::hypot(along, inner.y() - outer.y()) > 0.006) continue;
      ++compared;
      EXPECT_GT(radius_of(outer), radius_of(inner));
    }
  EXPECT_GT(compared, 5);
}

TEST(Assemble, FixedPinsHoldTheirEdgeWhileTheRestIsSewn) {
  Scene scene = tube_scene();
  scene.body.reset();
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}};
  const Cloth apart = build_cloth(scene);
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  for (int v : pinned_vertices(scene.garments[0].pins[0], 0, apart))
    EXPECT_LT((sewn.cloth().x[sewn.assembly.old_to_new[v]] - apart.x[v]).norm(), 1e-9);
}

TEST(Assemble, AttachedVerticesKeepTheirHeightAndAreListed) {
  Scene scene = tube_scene();
  auto& pattern = std::get<Pattern>(scene.garments[0].shape);
  for (Panel& panel : pattern.panels) panel.edges[2].label = "lower_interface";
  scene.garments[0].pins = {{PinLabel{"lower_interface"}, PinAttached{}}};
  const Sewn sewn = sew(scene);
  expect_sound(sewn);
  std::size_t on_top = 0;
  for (const LabelledVertices& l : sewn.cloth().labels)
    if (l.label == "lower_interface") on_top += l.vertices.size();
  EXPECT_GT(sewn.assembly.attached.size(), 10u);
  EXPECT_LE(sewn.assembly.attached.size(), on_top);
  for (int v : sewn.assembly.attached) EXPECT_NEAR(sewn.cloth().x[v].y(), 0.05, 1e-3);
}

TEST(Assemble, SeamsThatCannotMeetAreNamed) {
  Scene scene = tube_scene(0.05);
  auto& pattern = std::get<Pattern>(scene.garments[0].shape);
  for (Panel& panel : pattern.panels)  // girth 0.4 m for a body of 0.63 m: both sides of every seam are held apart
    for (Vec2& v : panel.vertices) v.x() *= 0.55;
  scene.garments[0].pins = {{PinEdge{0, 1}, PinFixed{}}, {PinEdge{1, 3}, PinFixed{}}};
  const Sewn sewn = sew(scene);
  ASSERT_EQ(sewn.assembly.open_seams.size(), 1u);
  EXPECT_NE(sewn.assembly.open_seams[0].find("front"), std::string::npos);
  EXPECT_GT(sewn.assembly.seam_gap_max, 0.1);
}

TEST(Assemble, CancelsWhenProgressSaysSo) {
  const Scene scene = tube_scene();
  const BodyField body = make_body_field(*scene.body, 0.03);
  int calls = 0;
  double fraction = -1;
  EXPECT_THROW(assemble(scene, build_cloth(scene), {&body, nullptr},
                        [&](const AssemblyState& state) {
                          EXPECT_GE(state.fraction, fraction);
                          EXPECT_NE(state.x, nullptr);
                          fraction = state.fraction;
                          return ++calls < 7;
                        }),
               Cancelled);
  EXPECT_EQ(calls, 7);
}

TEST(Assemble, WithoutSeamsTheClothStaysAsItIs) {
  Scene scene;
  scene.garments = {square_garment(0.2, 0.05, 0)};
  const Cloth apart = build_cloth(scene);
  const Sewn sewn = sew(scene);
  EXPECT_EQ(sewn.cloth().x, apart.x);
  EXPECT_EQ(sewn.assembly.seam_gap_max, 0);
  EXPECT_TRUE(sewn.assembly.open_seams.empty());
}

}  // namespace
}  // namespace toile
