#include "engine/quality/admissible_forces.h"

#include "tests/engine/quality/slope_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace toile {
namespace {

using namespace test;

double rms(const Positions& net, const std::vector<double>& mass, const std::vector<char>& held) {
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < mass.size(); ++v)
    if (!held[v]) sum += std::pow(net[v].norm() / (mass[v] * kGravity), 2), ++count;
  return std::sqrt(sum / count);
}

/// Pushes one node along y with up to `force`.
FrictionMoment lift(int node, double force) {
  FrictionMoment m{{node, node, node, node, node, node}, Eigen::Matrix<double, 18, 3>::Zero()};
  m.arm(1, 0) = force;
  return m;
}

TEST(AdmissibleForces, WithoutMomentsIsTheDistanceToTheCone) {
  for (const double slope : {0.0, 0.1, 0.28, 0.35, 0.8, 1.4})
    for (const double friction : {0.0, 0.3}) {
      const std::vector<Contact> contacts{slope_contact(0, slope, friction)};
      const AdmissibleContact found = admissible_forces(contacts, {}, {Vec3(0, -kNodeWeight, 0)}, {kNodeMass}, {0});
      const double expected = kNodeWeight * std::sin(std::max(0.0, slope - std::atan(friction)));
      EXPECT_NEAR(found.net_force[0].norm(), expected, 5e-3 * kNodeWeight) << slope << ' ' << friction;
      const double pressure = found.contact_force[0].dot(contacts[0].normal);
      EXPECT_GT(pressure, 0);
      EXPECT_LE((found.contact_force[0] - pressure * contacts[0].normal).norm(), friction * pressure + 1e-12);
    }
}

TEST(AdmissibleForces, AMomentGivesWhatItsBoundAllows) {
  for (const double share : {0.5, 0.99, 1.0, 1.5}) {
    const AdmissibleContact found =
        admissible_forces({}, {lift(0, share * kNodeWeight)}, {Vec3(0, -kNodeWeight, 0)}, {kNodeMass}, {0});
    EXPECT_NEAR(found.net_force[0].norm(), std::max(0.0, 1 - share) * kNodeWeight, 3e-3 * kNodeWeight) << share;
  }
}

/// The bound theorems of limit analysis: a cantilever of plastic moment M carries the weights w at x if Σ w x ≤ M, and
/// not more. A chain of 60 is what going from joint to joint would not solve.
TEST(AdmissibleForces, ACantileverCarriesItsPlasticMomentAndNoMore) {
  constexpr int n = 60;
  const double edge = 5e-3;
  const std::vector<double> mass(n, kNodeMass);
  std::vector<char> held(n, 0);
  held[0] = held[1] = 1;
  const Positions load(n, Vec3(0, -kNodeWeight, 0));
  double needed = 0;  // at the second node
  for (int v = 2; v < n; ++v) needed += kNodeWeight * edge * (v - 1);
  for (const double share : {0.5, 0.9, 1.02, 2.0}) {
    std::vector<FrictionMoment> joints;
    for (int v = 1; v + 1 < n; ++v) {
      FrictionMoment m{{v - 1, v, v + 1, v, v, v}, Eigen::Matrix<double, 18, 3>::Zero()};
      m.arm(1, 0) = m.arm(7, 0) = share * needed / edge;
      m.arm(4, 0) = -2 * share * needed / edge;
      joints.push_back(m);
    }
    const double left = rms(admissible_forces({}, joints, load, mass, held).net_force, mass, held);
    if (share > 1)
      EXPECT_LT(left, 3e-3) << share;
    else
      EXPECT_GT(left, 0.05 * (1 - share)) << share;
  }
}

TEST(AdmissibleForces, LeavesNoMoreThanAnyChoiceOfContactForces) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr int n = 30;
  std::vector<Contact> contacts;
  Positions load(n);
  for (int v = 0; v < n; ++v) {
    load[static_cast<std::size_t>(v)] = kNodeWeight * Vec3(normal(random), normal(random), normal(random));
    Contact c = slope_contact(v, 0.5 * normal(random), 0.4);
    c.nodes[1] = (v + 7) % n;
    c.weights[1] = -0.6;
    c.count = 2;
    contacts.push_back(c);
  }
  const std::vector<double> mass(n, kNodeMass);
  const std::vector<char> held(n, 0);
  const double swept = rms(admissible_contact(contacts, load, mass, held).net_force, mass, held);
  const double best = rms(admissible_forces(contacts, {}, load, mass, held).net_force, mass, held);
  EXPECT_NEAR(best, swept, 5e-3 * swept);
}

TEST(AdmissibleForces, ABilateralContactPulls) {
  Contact ceiling = slope_contact(0, 0, 0.3);
  ceiling.normal = -Vec3::UnitY();
  ceiling.bilateral = true;
  const AdmissibleContact found =
      admissible_forces({ceiling}, {lift(0, 0.1 * kNodeWeight)}, {Vec3(0, -kNodeWeight, 0)}, {kNodeMass}, {0});
  EXPECT_LT(found.net_force[0].norm(), 5e-3 * kNodeWeight);
  EXPECT_GT(found.contact_force[0].y(), 0.8 * kNodeWeight);
}

TEST(AdmissibleForces, HeldNodesTakeAnyForceAndThoseBeyondTheMassesToo) {
  const AdmissibleContact found =
      admissible_forces({}, {lift(1, kNodeWeight), lift(7, kNodeWeight)}, {Vec3(0, -kNodeWeight, 0), Vec3(1, 0, 0)},
                        {kNodeMass, kNodeMass}, {0, 1});
  EXPECT_NEAR(found.net_force[0].norm(), kNodeWeight, 1e-12);
  EXPECT_EQ(found.net_force[1].norm(), 0);
}

}  // namespace
}  // namespace toile
