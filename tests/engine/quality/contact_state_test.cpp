#include "engine/quality/contact_state.h"

#include "engine/terms/contact.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

constexpr double kStiffness = 100;  // [N/m]

/// One vertex on a floor whose repulsion begins 2 mm above it.
Contact on_floor(double friction) {
  Contact c;
  c.weights = {1, 0, 0, 0};
  c.count = 1;
  c.normal = Vec3::UnitY();
  c.distance = 2e-3;
  c.friction = friction;
  return c;
}

TEST(ContactState, CountsWhatPressesAndWhatSticks) {
  Contact open = on_floor(0.5), sticks = on_floor(0.5), slides = on_floor(0.5), smooth = on_floor(0);
  open.offset = -1e-3;                  // the floor is lower here
  sticks.anchor = Vec3(2e-4, 1e-3, 0);  // pressed 1 mm: slides beyond 0.5 mm
  slides.anchor = Vec3(0, 1e-3, -3e-3);
  const Positions x{Vec3(0, 1e-3, 0)};
  const std::vector<Contact> contacts{open, sticks, slides, smooth};
  const ContactState state = contact_state(contacts, kStiffness, x);
  EXPECT_EQ(state.pressing, 3);
  EXPECT_EQ(state.sticking, 1);
  EXPECT_NEAR(state.repulsion_energy, 3 * 0.5 * kStiffness * 1e-6, 1e-15);
  EXPECT_NEAR(state.friction_energy, 0.5 * kStiffness * (2e-4 * 2e-4 + 5e-4 * 5e-4), 1e-15);
}

/// The energy is the work of the push, whichever part of the law (terms/contact.h) it comes from.
TEST(ContactState, StoresTheWorkThatItTookToPress) {
  Contact layers = on_floor(0), body = on_floor(0), slider = on_floor(0);
  layers.between_layers = slider.bilateral = true;
  const auto at = [](double gap) { return Positions{Vec3(0, gap, 0)}; };
  for (const auto& [contact, gap] : {std::pair{layers, 0.1e-3}, {layers, 1.5e-3}, {body, -0.8e-3}, {slider, 3e-3}}) {
    constexpr int kParts = 20000;
    double work = 0;
    for (int k = 0; k < kParts; ++k) {
      const double middle = contact.distance + (k + 0.5) / kParts * (gap - contact.distance);
      work -= contact_response(contact, kStiffness, Vec3(0, middle, 0)).force.y() * (gap - contact.distance) / kParts;
    }
    const ContactState state = contact_state({&contact, 1}, kStiffness, at(gap));
    EXPECT_NEAR(state.repulsion_energy, work, 1e-5 * work) << gap;
    EXPECT_EQ(state.friction_energy, 0) << gap;
  }
}

TEST(ContactState, NothingOfNothing) {
  const ContactState state = contact_state({}, kStiffness, {});
  EXPECT_EQ(state.pressing, 0);
  EXPECT_EQ(state.repulsion_energy, 0);
}

}  // namespace
}  // namespace toile
