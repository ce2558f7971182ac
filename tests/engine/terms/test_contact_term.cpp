#include "engine/terms/air_drag.h"
#include "engine/terms/contact.h"
#include "engine/terms/gravity.h"
#include "engine/terms/mass.h"
#include "tests/engine/solve/sheets.h"
#include "tests/engine/terms/check_term.h"

#include <numeric>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kStiffness = 100;

/// A vertex against a triangle, tilted normal.
Contact vertex_triangle(double friction) {
  Contact c;
  c.nodes = {0, 1, 2, 3};
  c.weights = {1, -0.2, -0.5, -0.3};
  c.count = 4;
  c.normal = Vec3(0.2, 0.9, -0.3).normalized();
  c.distance = 2e-3;
  c.friction = friction;
  return c;
}

/// Nodes such that p = depth below the active distance along the normal, plus a tangential offset.
StencilPoints<4> nodes_for(const Contact& c, double depth, const Vec3& along) {
  StencilPoints<4> x = {Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(-0.004, 0, 0.01), Vec3(0.0, 0, -0.0166666)};
  const Positions list(x.begin(), x.end());
  const Vec3 tangential = along - c.normal.dot(along) * c.normal;
  x[0] += (c.distance - depth) * c.normal + tangential - contact_point(c, list);
  return x;
}

Vec3 point_of(const Contact& c, const StencilPoints<4>& x) { return contact_point(c, Positions(x.begin(), x.end())); }

Potential<4> potential(const Contact& c) {
  return {[=](const auto& x) { return contact_energy(c, kStiffness, point_of(c, x)); },
          [=](const auto& x) {
            const Vec3 f = contact_response(c, kStiffness, point_of(c, x)).force;
            StencilVector<4> g;
            for (int i = 0; i < 4; ++i) g.segment<3>(3 * i) = -c.weights[i] * f;
            return g;
          },
          [=](const auto& x) {
            const Mat3 h = contact_response(c, kStiffness, point_of(c, x)).hessian;
            StencilMatrix<4> full;
            for (int i = 0; i < 4; ++i)
              for (int j = 0; j < 4; ++j) full.block<3, 3>(3 * i, 3 * j) = c.weights[i] * c.weights[j] * h;
            return full;
          },
          [=](const auto& x) { return potential(c).hessian(x); }};
}

}  // namespace

TEST(ContactTerm, RepulsionDerivatives) {
  const Contact c = vertex_triangle(0);
  for (double depth : {1e-4, 1e-3, 5e-3})
    check_derivatives<4>(potential(c), nodes_for(c, depth, Vec3::Zero()), depth, "pressed");
  const auto open = nodes_for(c, -1e-4, Vec3::Zero());
  EXPECT_EQ(potential(c).energy(open), 0);
  EXPECT_EQ(potential(c).gradient(open).norm(), 0);
}

TEST(ContactTerm, RepulsionBetweenLayersGrowsBeyondAnyLoad) {
  Contact c = vertex_triangle(0);
  const ContactResponse half = contact_response(c, kStiffness, 0.5 * c.distance * c.normal);
  c.between_layers = true;
  for (double gap : {0.7, 0.3, 0.05, 2e-3, 5e-4, -0.1})
    check_derivatives<4>(potential(c), nodes_for(c, (1 - gap) * c.distance, Vec3::Zero()),
                         std::max(std::abs(gap), 1e-3) * c.distance, "layers");
  // Down to half the distance it is the quadratic repulsion; there force and stiffness go on without a jump.
  for (double gap : {0.5 + 1e-12, 0.5 - 1e-12}) {
    const ContactResponse r = contact_response(c, kStiffness, gap * c.distance * c.normal);
    EXPECT_NEAR(r.normal_force, half.normal_force, 1e-9 * half.normal_force);
    EXPECT_NEAR((r.hessian - half.hessian).norm(), 0, 1e-9 * kStiffness);
  }
  const double load = 100 * half.normal_force;
  const double gap = 0.25 * kStiffness * c.distance * c.distance / load;
  EXPECT_NEAR(contact_response(c, kStiffness, gap * c.normal).normal_force, load, 1e-9 * load);
}

TEST(ContactTerm, InsideABodyRepulsionIsFiveTimesAsStiff) {
  Contact c = vertex_triangle(0);
  for (double gap : {0.2e-3, -0.1e-3, -3e-3})
    check_derivatives<4>(potential(c), nodes_for(c, c.distance - gap, Vec3::Zero()), std::abs(gap), "inside");
  const auto force = [&](double gap) { return contact_response(c, kStiffness, gap * c.normal).normal_force; };
  EXPECT_NEAR(force(-1e-12), kStiffness * c.distance, 1e-9);
  EXPECT_NEAR(force(-1e-3) - force(0), 5 * kStiffness * 1e-3, 1e-12);
}

TEST(ContactTerm, ABilateralContactPullsBackWhatLeaves) {
  Contact c = vertex_triangle(0);
  c.bilateral = true;
  for (double depth : {-3e-3, -1e-4, 1e-3})
    check_derivatives<4>(potential(c), nodes_for(c, depth, Vec3::Zero()), std::abs(depth), "bilateral");
  c.friction = 0.5;
  const Vec3 p = point_of(c, nodes_for(c, -1e-3, Vec3(2e-3, 0, 1e-3)));
  const ContactResponse r = contact_response(c, kStiffness, p);
  EXPECT_NEAR(r.force.dot(c.normal), -kStiffness * 1e-3, 1e-12);
  EXPECT_NEAR(r.normal_force, kStiffness * 1e-3, 1e-12);
  EXPECT_TRUE(r.sliding);
  EXPECT_NEAR((r.force - r.force.dot(c.normal) * c.normal).norm(), 0.5 * r.normal_force, 1e-12);
}

TEST(ContactTerm, StickingDerivatives) {
  const Contact c = vertex_triangle(0.5);
  const auto x = nodes_for(c, 1e-3, Vec3(1e-4, 0, 2e-4));
  EXPECT_FALSE(contact_response(c, kStiffness, point_of(c, x)).sliding);
  check_derivatives<4>(potential(c), x, 1e-4, "sticking");
}

TEST(ContactTerm, SlidingForceIsOnTheCone) {
  const Contact c = vertex_triangle(0.5);
  const Vec3 p = point_of(c, nodes_for(c, 1e-3, Vec3(2e-3, 0, 1e-3)));
  const ContactResponse r = contact_response(c, kStiffness, p);
  ASSERT_TRUE(r.sliding);
  EXPECT_NEAR(r.normal_force, kStiffness * 1e-3, 1e-12);
  const Vec3 friction = r.force - r.force.dot(c.normal) * c.normal;
  EXPECT_NEAR(friction.norm(), 0.5 * r.normal_force, 1e-12);
  EXPECT_LT(friction.dot(p - c.anchor), 0);
  // At fixed normal force, the tangential Hessian is minus the derivative of the friction force.
  Vec3 t1 = c.normal.unitOrthogonal(), t2 = c.normal.cross(t1);
  for (const Vec3& t : {t1, t2}) {
    const Vec3 slope = ridders<Vec3>([&](double s) { return contact_response(c, kStiffness, p + s * t).force; }, 1e-4);
    EXPECT_LT((slope + r.hessian * t).norm(), 1e-6 * kStiffness);
  }
  EXPECT_GT(eigenvalues_of(r.hessian).minCoeff(), -1e-10 * kStiffness);
}

TEST(ContactTerm, NetForceOfClothAgainstClothIsZero) {
  const Contact c = vertex_triangle(0.5);
  const StencilVector<4> g = potential(c).gradient(nodes_for(c, 1e-3, Vec3(2e-3, 0, 1e-3)));
  const Vec3 net = g.segment<3>(0) + g.segment<3>(3) + g.segment<3>(6) + g.segment<3>(9);
  EXPECT_LT(net.norm(), 1e-12 * g.norm());
}

TEST(ContactTerm, AnchorFollowsASlideAndForgetsWhenOpen) {
  Contact c = vertex_triangle(0.5);
  const auto slid = nodes_for(c, 1e-3, Vec3(2e-3, 0, 1e-3));
  const Vec3 force = contact_response(c, kStiffness, point_of(c, slid)).force;
  advance_anchor(c, kStiffness, Positions(slid.begin(), slid.end()));
  const ContactResponse after = contact_response(c, kStiffness, point_of(c, slid));
  EXPECT_LT((after.force - force).norm(), 1e-9 * force.norm());  // the force does not jump
  const Vec3 anchor = c.anchor;
  advance_anchor(c, kStiffness, Positions(slid.begin(), slid.end()));
  EXPECT_LT((c.anchor - anchor).norm(), 1e-12);  // a contact at the cone stays
  const auto open = nodes_for(c, -1e-3, Vec3(1e-3, 0, 0));
  advance_anchor(c, kStiffness, Positions(open.begin(), open.end()));
  EXPECT_LT((c.anchor - point_of(c, open)).norm(), 1e-15);
}

TEST(Gravity, Derivatives) {
  const Potential<1> weight = {[](const auto& x) { return gravity_energy(0.1, x[0]); },
                               [](const auto&) { return StencilVector<1>(gravity_gradient(0.1)); },
                               [](const auto&) { return StencilMatrix<1>(StencilMatrix<1>::Zero()); }};
  check_derivatives<1>(weight, {Vec3(1, 2, 3)}, 1, "weight");
  EXPECT_LT(-gravity_gradient(1).y(), 0);
}

TEST(AirDrag, Derivatives) {
  const Potential<1> drag = {
      [](const auto& v) { return air_drag_dissipation(5, 0.1, v[0]); },
      [](const auto& v) { return StencilVector<1>(air_drag_dissipation_gradient(5, 0.1, v[0])); },
      [](const auto&) { return StencilMatrix<1>(air_drag_dissipation_hessian(5, 0.1) * Mat3::Identity()); }};
  check_derivatives<1>(drag, {Vec3(1, 2, 3)}, 1, "drag");
}

TEST(Mass, IsTheFlatAreaTimesTheDensity) {
  const Cloth sheet = equilateral_sheet(10, 6, 0.01, suiting());
  const std::vector<double> mass = lumped_masses(sheet);
  EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), 0.2 * 0.1 * 6 * 0.01 * std::sqrt(3.0) / 2, 1e-12);
  for (double m : mass) EXPECT_GT(m, 0);
}
