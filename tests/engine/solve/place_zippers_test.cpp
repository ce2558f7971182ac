#include "engine/solve/place_zippers.h"

#include "engine/mesh/build_cloth.h"
#include "engine/mesh/sewing.h"
#include "engine/mesh/zippers.h"
#include "engine/scene/problem.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

constexpr double kLength = 0.2;

Scene zipped(double closed_fraction) { return zipped_halves(0.1, kLength, kLength, 0, closed_fraction); }

Cloth sewn(const Scene& scene) {
  Cloth cloth = build_cloth(scene);
  merge_seams(cloth);
  return cloth;
}

TEST(PlaceZippers, TapesWeighAsMuchAsTheZipperHoweverFarItIsClosed) {
  for (const double fraction : {0.0, 0.6, 1.0}) {
    const Scene scene = zipped(fraction);
    const Trimmings trimmings = make_trimmings(scene, sewn(scene));
    double mass = 0, closed_length = 0, stiffness_length = 0;
    for (const AddedMass& added : trimmings.masses) mass += added.mass;
    EXPECT_NEAR(mass, 0.02 * kLength, 1e-12);
    for (const ElasticStencil& s : trimmings.elastics) {
      stiffness_length += s.stiffness * s.rest_length;
      if (s.stiffness > 1500) closed_length += s.rest_length;
    }
    EXPECT_NEAR(closed_length, fraction * kLength, 1e-12);
    EXPECT_NEAR(stiffness_length, 2000 * kLength, 1e-9);  // half and half where it is open
    // A joint at every inner vertex; where it parts, both sides go on from the closed chain.
    EXPECT_EQ(trimmings.tapes.size(), fraction == 1 ? 9u : fraction == 0 ? 18u : 5u + 2 * 4u);
  }
}

TEST(PlaceZippers, EndsLieOnTheRightSideWithTheirSpringsAtRest) {
  for (const double fraction : {0.0, 0.6, 1.0}) {
    const Scene scene = zipped(fraction);
    const Cloth cloth = sewn(scene);
    const Trimmings trimmings = make_trimmings(scene, cloth);
    ASSERT_EQ(trimmings.trims.size(), fraction == 1 ? 2u : 4u);
    const Zipper& zipper = scene.garments[0].zippers[0];
    const RigidTrim& slider = trimmings.trims[0];
    EXPECT_EQ(slider.body.mass, zipper.slider.mass);
    const double half = 0.5 * zipper.slider.size.y();
    const double height = fraction == 0 ? half : fraction == 1 ? kLength - half : 0.6 * kLength;
    EXPECT_NEAR(slider.start.center.x(), 0, 1e-9);
    EXPECT_NEAR(slider.start.center.y(), height, 1e-9);
    EXPECT_GT(slider.start.center.z(), 0.5 * zipper.slider.size.z());
    EXPECT_LT((slider.start.orientation.toRotationMatrix() - Mat3::Identity()).norm(), 1e-9);
    std::vector<double> stiffness(trimmings.trims.size(), 0.0);
    for (const AttachmentStencil& s : trimmings.attachments) {
      stiffness[static_cast<std::size_t>(s.trim)] += s.stiffness;
      const RigidState& at = trimmings.trims[static_cast<std::size_t>(s.trim)].start;
      Vec3 apart = at.center + at.orientation * s.point;
      for (std::size_t i = 0; i < 3; ++i) apart -= s.weights[i] * cloth.x[static_cast<std::size_t>(s.cloth[i])];
      // But for the tapes that the slider spreads.
      EXPECT_LT(apart.norm(), s.trim == 0 && fraction == 0.6 ? 0.26 * zipper.slider.size.x() : 1e-9);
    }
    for (const double k : stiffness) EXPECT_NEAR(k, zipper.thread_stiffness, 1e-9);
  }
}

TEST(PlaceZippers, ASeamThatShortensOneSideIsRefused) {
  Scene scene = zipped_mesh(zipped(0.5));
  const std::vector<int>& side = std::get<PinVertices>(scene.garments[0].zippers[0].sides[1]).vertices;
  std::get<GarmentMesh>(scene.garments[0].shape).seams = {{side[8], side[9]}};
  try {
    make_trimmings(scene, sewn(scene));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "zipper_side");
  }
}

TEST(PlaceZippers, AZipperShorterThanItsEndsIsRefused) {
  Scene scene = zipped(0.5);
  scene.garments[0].zippers[0].slider.size.y() = 0.11;
  try {
    make_trimmings(scene, sewn(scene));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "zipper_too_short");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/0/zippers/0");
  }
}

}  // namespace
}  // namespace toile
