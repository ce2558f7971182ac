// Buttons in the whole engine: what hangs by a button hangs with its weight.

#include "engine/drape.h"
#include "engine/parallel/state_hash.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>
#include <numeric>

using namespace toile;
using namespace toile::test;

namespace {

/// A panel that is pinned by its top, and one that nothing but a button holds to it.
Scene hung_by_a_button() {
  Panel upper = rectangle_panel("upper", 0.06, 0.06), lower = rectangle_panel("lower", 0.06, 0.1);
  lower.translation = Vec3(0, -0.08, -4e-3);
  Scene scene;
  scene.garments = {garment_of(Pattern{{upper, lower}, {}}, 0.01)};
  Trim trim;
  trim.holes = {{"upper", Vec2(0, 0.01)}, {"lower", Vec2(0, 0.09)}};
  trim.stiffness = 200;
  scene.garments[0].trims = {trim};
  scene.garments[0].pins = {{PinEdge{0, 2}, PinFixed{}}};
  scene.solver.max_time_step = 2e-3;
  scene.solver.rest_kinetic_energy = 1e-12;
  scene.solver.rest_residual = 5e-3;
  return scene;
}

}  // namespace

/// Where the pin is a clamp, its points lie between the cloth's nodes and the button's.
class ButtonReference : public ::testing::TestWithParam<bool> {};

TEST_P(ButtonReference, CarriesTheWeightOfWhatHangsByIt) {
  Scene scene = hung_by_a_button();
  scene.garments[0].pins[0].clamp = GetParam();
  CountingMonitor monitor;
  const Drape result = drape(scene, monitor);
  EXPECT_EQ(result.report.status, "converged");
  ASSERT_EQ(result.trims.size(), 1u);
  const Trimmings trimmings = make_trimmings(scene, build_cloth(scene));
  Vec3 on_layer[2] = {Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < trimmings.attachments.size(); ++k) {
    const AttachmentStencil& s = trimmings.attachments[k];
    const Positions& x = result.cloth.x;
    const RigidState& at = result.trims[0].start;
    on_layer[k / 4] +=
        s.stiffness * attachment_state(s, {x[s.cloth[0]], x[s.cloth[1]], x[s.cloth[2]], at.center},
                                       at.orientation.toRotationMatrix(), result.trims[0].body.gyration())
                          .stretch;
  }
  const double hanging = scene.garments[0].fabric.area_density * 0.06 * 0.1 * kGravity;
  const double button = scene.garments[0].trims[0].button.mass * kGravity;
  std::cout << "force on what hangs [N]: reference " << hanging << ", ours " << on_layer[1].y() << ", error "
            << 100 * (on_layer[1].y() / hanging - 1) << " %\nforce on what carries [N]: reference " << hanging + button
            << ", ours " << -on_layer[0].y() << ", error " << 100 * (-on_layer[0].y() / (hanging + button) - 1)
            << " %\n";
  EXPECT_NEAR(on_layer[1].y(), hanging, 0.01 * hanging);
  EXPECT_NEAR(-on_layer[0].y(), hanging + button, 0.01 * (hanging + button));
  EXPECT_EQ(result.contact_force.size(), result.cloth.x.size());
}

INSTANTIATE_TEST_SUITE_P(Hold, ButtonReference, ::testing::Bool(),
                         [](const auto& hold) { return hold.param ? "clamp" : "hinge"; });

TEST(Buttons, SameBytesOnAnyNumberOfThreads) {
  Scene scene = hung_by_a_button();
  scene.garments[0].pins[0].clamp = true;
  scene.garments[0].elastics = {{PinEdge{0, 0}, 0.8, 20, 0.02}};
  scene.garments[0].drawcords = {{PinEdge{1, 0}, 0.05, 200, 0.02}};
  scene.solver.simulated_time_limit = 0.15;
  std::string first;
  for (int threads : {1, 2}) {
    scene.solver.threads = threads;
    CountingMonitor monitor;
    const Drape result = drape(scene, monitor);
    Positions all = result.cloth.x;
    all.push_back(result.trims[0].start.center);
    all.push_back(result.trims[0].start.orientation.vec());
    const std::string hash = sha256_hex(all);
    if (first.empty()) first = hash;
    EXPECT_EQ(hash, first);
  }
}
