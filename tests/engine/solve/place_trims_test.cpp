#include "engine/solve/place_trims.h"

#include "engine/geometry/rotation.h"
#include "engine/scene/problem.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

/// Two upright layers, the first 4 mm before the second, one button through both.
Scene buttoned() {
  Panel under = rectangle_panel("under", 0.1, 0.1), over = rectangle_panel("over", 0.1, 0.1);
  over.translation.z() = 4e-3;
  Scene scene;
  scene.garments = {garment_of(Pattern{{under, over}, {}}, 0.01)};
  Trim trim;
  trim.holes = {{"over", Vec2(0.011, 0.052)}, {"under", Vec2(0.011, 0.052)}};
  scene.garments[0].trims = {trim};
  return scene;
}

Trimmings placed(const Scene& scene) { return make_trimmings(scene, build_cloth(scene)); }

Vec3 cloth_end(const Cloth& cloth, const AttachmentStencil& s) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 3; ++i) x += s.weights[i] * cloth.x[s.cloth[i]];
  return x;
}

TEST(PlaceTrims, AButtonLiesOnTheRightSideOverItsFirstHole) {
  const Scene scene = buttoned();
  const Trimmings trimmings = placed(scene);
  ASSERT_EQ(trimmings.trims.size(), 1u);
  const RigidState& at = trimmings.trims[0].start;
  EXPECT_NEAR(at.center.x(), 0.011, 1e-12);
  EXPECT_NEAR(at.center.y(), 0.052, 1e-12);
  EXPECT_GT(at.center.z(), 4e-3 + 0.5 * scene.garments[0].trims[0].button.thickness);
  EXPECT_LT((at.orientation * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(trimmings.trims[0].body.mass, scene.garments[0].trims[0].button.mass);
}

TEST(PlaceTrims, AHoleIsWhereItIsDrawnWhateverTheGrain) {
  Scene scene = buttoned();
  scene.garments[0].grain = 0.7;
  const RigidState at = placed(scene).trims.at(0).start;
  EXPECT_NEAR(at.center.x(), 0.011, 1e-12);
  EXPECT_NEAR(at.center.y(), 0.052, 1e-12);
}

TEST(PlaceTrims, SpringsHoldEachLayerBelowTheSamePointOfTheButton) {
  const Scene scene = buttoned();
  const Cloth cloth = build_cloth(scene);
  const Trimmings trimmings = placed(scene);
  ASSERT_EQ(trimmings.attachments.size(), 8u);
  const RigidState& at = trimmings.trims[0].start;
  for (std::size_t k = 0; k < 8; ++k) {
    const AttachmentStencil& s = trimmings.attachments[k];
    EXPECT_EQ(s.stiffness, 250);
    const Vec3 apart = at.center + at.orientation * s.point - cloth_end(cloth, s);
    EXPECT_LT(apart.head<2>().norm(), 1e-12);
    if (k < 4) {
      EXPECT_NEAR(apart.z(), 0, 1e-12);  // the layer that it lies on is where it should be
    } else {
      EXPECT_GT(apart.z(), 1e-3);  // the other is drawn up to it
    }
  }
}

TEST(PlaceTrims, TheWayThatTheGarmentLiesDoesNotMatter) {
  Scene scene = buttoned();
  const Mat3 turned = rotation_by(Vec3(0.4, -1.1, 0.7)).toRotationMatrix();
  for (Panel& panel : std::get<Pattern>(scene.garments[0].shape).panels) {
    panel.translation = turned * panel.translation + Vec3(0.1, 1, -0.2);
    panel.rotation = turned * panel.rotation;
  }
  const RigidState straight = placed(buttoned()).trims[0].start, at = placed(scene).trims[0].start;
  EXPECT_LT((at.center - turned * straight.center - Vec3(0.1, 1, -0.2)).norm(), 1e-12);
  EXPECT_LT((at.orientation.toRotationMatrix() - turned * straight.orientation.toRotationMatrix()).norm(), 1e-12);
}

TEST(PlaceTrims, APlaceOffThePanelIsNamed) {
  for (const Vec2& at : {Vec2(0.2, 0.05), Vec2(0.0499, 0.05)}) {  // the hole, or the thread around it
    Scene scene = buttoned();
    scene.garments[0].trims[0].holes[1].at = at;
    try {
      placed(scene);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems()[0].code, "trim_off_panel");
      EXPECT_EQ(error.problems()[0].pointer, "/garments/0/trims/0/attach/1");
    }
  }
}

TEST(AppendTrims, DrawsADiscAtItsPlace) {
  const Scene scene = buttoned();
  TriangleMesh mesh;
  const Trimmings trimmings = placed(scene);
  append_trims(trimmings.trims, mesh);
  ASSERT_FALSE(mesh.triangles.empty());
  const Button& button = scene.garments[0].trims[0].button;
  for (const Vec3& v : mesh.vertices) {
    const Vec3 off = v - trimmings.trims[0].start.center;
    EXPECT_LE(off.head<2>().norm(), 0.5 * button.diameter + 1e-9);
    EXPECT_LE(std::abs(off.z()), 0.5 * button.thickness + 1e-9);
  }
}

}  // namespace
}  // namespace toile
