#include "engine/solve/preview.h"

#include "engine/monitor.h"
#include "engine/parallel/state_hash.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <memory>

namespace toile {
namespace {

using namespace test;

const std::function<bool(double, long)> kNeverCancel = [](double, long) { return true; };

struct Preview {
  Preview() {
    scene.garments = {square_garment(0.2, 0.02, 0.105)};
    scene.body = Body{SphereBody{Vec3::Zero(), 0.1}, 0.3};
    body = std::make_unique<BodyField>(make_body_field(*scene.body, 0.02));
    cloth = build_cloth(scene);
  }
  Scene scene;
  std::unique_ptr<BodyField> body;
  Cloth cloth;
};

TEST(SettlePreview, ASquareLiesOnABall) {
  Preview p;
  const PreviewOutcome outcome = settle_preview(p.scene, p.cloth, p.body.get(), {}, kNeverCancel);
  EXPECT_GT(outcome.steps, 50);
  EXPECT_LE(outcome.steps, 1500);
  EXPECT_TRUE(all_finite(p.cloth.x));
  EXPECT_EQ(self_intersections(p.cloth.x, p.cloth.triangles).size(), 0u);
  for (const Vec3& x : p.cloth.x) EXPECT_GT(p.body->distance(x), 0);
  double lowest = 1;
  for (const Vec3& x : p.cloth.x) lowest = std::min(lowest, x.y());
  EXPECT_LT(lowest, 0.07);
}

TEST(SettlePreview, FrictionKeepsItOnTheBallAndWithoutItItSlidesOff) {
  for (const double friction : {0.3, 0.0}) {
    Preview p;
    p.scene.body->friction = friction;
    for (Vec3& x : p.cloth.x) x.x() += 0.02;
    const PreviewOutcome outcome = settle_preview(p.scene, p.cloth, p.body.get(), {}, kNeverCancel);
    EXPECT_EQ(outcome.at_rest, friction > 0);
    EXPECT_EQ(p.cloth.x[0].y() > -0.1, friction > 0);
  }
}

TEST(SettlePreview, HeldVerticesEndWhereTheirLastKeyFramePutsThem) {
  Preview p;
  PinMoved lift;
  lift.key_frames = {{0, Vec3::Zero(), Vec3::Zero()}, {1, Vec3(0, 0.02, 0), Vec3::Zero()}};
  const std::vector<HeldVertex> held = {{0, p.cloth.x[0], &lift}, {1, p.cloth.x[1], nullptr}};
  settle_preview(p.scene, p.cloth, nullptr, held, kNeverCancel);
  EXPECT_LT((p.cloth.x[0] - held[0].start - Vec3(0, 0.02, 0)).norm(), 1e-12);
  EXPECT_EQ(p.cloth.x[1], held[1].start);
  EXPECT_TRUE(all_finite(p.cloth.x));
}

TEST(SettlePreview, NothingHoldsItSoItNeverRests) {
  Preview p;
  const PreviewOutcome outcome = settle_preview(p.scene, p.cloth, nullptr, {}, kNeverCancel);
  EXPECT_FALSE(outcome.at_rest);
  EXPECT_EQ(outcome.steps, 1500);
  EXPECT_TRUE(all_finite(p.cloth.x));
}

TEST(SettlePreview, SameBytesTwice) {
  Preview a, b;
  settle_preview(a.scene, a.cloth, a.body.get(), {}, kNeverCancel);
  settle_preview(b.scene, b.cloth, b.body.get(), {}, kNeverCancel);
  EXPECT_EQ(sha256_hex(a.cloth.x), sha256_hex(b.cloth.x));
}

TEST(SettlePreview, Cancels) {
  Preview p;
  int calls = 0;
  double last = 0;
  const auto progress = [&](double fraction, long) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return ++calls < 5;
  };
  EXPECT_THROW(settle_preview(p.scene, p.cloth, p.body.get(), {}, progress), Cancelled);
  EXPECT_EQ(calls, 5);
}

}  // namespace
}  // namespace toile
