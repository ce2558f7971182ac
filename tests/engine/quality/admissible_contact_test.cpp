#include "engine/quality/admissible_contact.h"

#include "tests/engine/quality/slope_contact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace toile {
namespace {

using namespace test;

const Positions kFalling{Vec3(0, -kNodeWeight, 0)};

TEST(AdmissibleContact, FrictionHoldsWhatIsNotTooSteep) {
  for (const double slope : {0.0, 0.1, 0.28}) {
    const std::vector<Contact> contacts{slope_contact(0, slope, 0.3)};
    const AdmissibleContact found = admissible_contact(contacts, kFalling, {kNodeMass}, {0});
    EXPECT_LT(found.net_force[0].norm(), 1e-12) << slope;
    EXPECT_NEAR(found.contact_force[0].y(), kNodeWeight, 1e-12);
    const ContactCount count = count_contacts(contacts, found.contact_force);
    EXPECT_EQ(count.pressing, 1);
    EXPECT_EQ(count.sticking, 1);
  }
}

/// The distance from the weight to the cone: mg sin(slope − angle of friction).
TEST(AdmissibleContact, OnASteepSlopeTheDistanceToTheConeIsLeft) {
  for (const double slope : {0.35, 0.8, 1.4}) {
    const std::vector<Contact> contacts{slope_contact(0, slope, 0.3)};
    const AdmissibleContact found = admissible_contact(contacts, kFalling, {kNodeMass}, {0});
    EXPECT_NEAR(found.net_force[0].norm(), kNodeWeight * std::sin(slope - std::atan(0.3)), 1e-12) << slope;
    const Vec3& force = found.contact_force[0];
    const double pressure = force.dot(contacts[0].normal);
    EXPECT_NEAR((force - pressure * contacts[0].normal).norm(), 0.3 * pressure, 1e-12);
    EXPECT_EQ(count_contacts(contacts, found.contact_force).sticking, 0);
  }
}

TEST(AdmissibleContact, ContactsDoNotPull) {
  for (const double friction : {0.3, 0.0}) {
    const std::vector<Contact> contacts{slope_contact(0, 0, friction)};
    const AdmissibleContact found = admissible_contact(contacts, {Vec3(0, kNodeWeight, 0)}, {kNodeMass}, {0});
    EXPECT_EQ(found.contact_force[0], Vec3(Vec3::Zero()));
    EXPECT_NEAR(found.net_force[0].y(), kNodeWeight, 1e-15);
    EXPECT_EQ(count_contacts(contacts, found.contact_force).pressing, 0);
  }
}

TEST(AdmissibleContact, BilateralContactsPullAndRubUnderPull) {
  Contact ceiling = slope_contact(0, 0, 0.3);
  ceiling.normal = -Vec3::UnitY();
  const Vec3 hanging(0.25 * kNodeWeight, -kNodeWeight, 0);  // and pulled aside within its friction
  EXPECT_GT(admissible_contact({ceiling}, {hanging}, {kNodeMass}, {0}).net_force[0].norm(), kNodeWeight);
  ceiling.bilateral = true;
  const AdmissibleContact found = admissible_contact({ceiling}, {hanging}, {kNodeMass}, {0});
  EXPECT_LT(found.net_force[0].norm(), 1e-12);
  const std::vector<Contact> contacts{ceiling};
  const ContactCount count = count_contacts(contacts, found.contact_force);
  EXPECT_EQ(count.pressing, 1);
  EXPECT_EQ(count.sticking, 1);
  const Vec3 dragged(0.5 * kNodeWeight, -kNodeWeight, 0);
  EXPECT_GT(admissible_contact({ceiling}, {dragged}, {kNodeMass}, {0}).net_force[0].norm(), 0.1 * kNodeWeight);
}

/// A layer on a layer on a floor: the lower contact bears both weights.
TEST(AdmissibleContact, LayersPassTheirWeightOn) {
  Contact between = slope_contact(0, 0, 0.3);
  between.nodes = {1, 0, 0, 0};
  between.weights = {1, -1, 0, 0};
  between.count = 2;
  const std::vector<Contact> contacts{between, slope_contact(0, 0, 0.3)};
  const Positions falling{Vec3(0, -kNodeWeight, 0), Vec3(0, -kNodeWeight, 0)};
  const AdmissibleContact found = admissible_contact(contacts, falling, {kNodeMass, kNodeMass}, {0, 0});
  for (const Vec3& net : found.net_force) EXPECT_LT(net.norm(), 1e-3 * kNodeWeight);
  EXPECT_NEAR(found.contact_force[0].y(), kNodeWeight, 1e-3 * kNodeWeight);
  EXPECT_NEAR(found.contact_force[1].y(), 2 * kNodeWeight, 1e-3 * kNodeWeight);
}

TEST(AdmissibleContact, HeldVerticesTakeWhatTheyMust) {
  const std::vector<Contact> contacts{slope_contact(0, 0, 0.3)};
  const AdmissibleContact found = admissible_contact(contacts, {Vec3(7, 8, 9)}, {kNodeMass}, {1});
  EXPECT_EQ(found.net_force[0], Vec3(Vec3::Zero()));
  EXPECT_EQ(found.contact_force[0], Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace toile
