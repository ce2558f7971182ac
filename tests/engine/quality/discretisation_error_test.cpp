#include "engine/quality/discretisation_error.h"

#include "tests/engine/solve/sheets.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

/// A sheet of about 0.2 m by 0.2 m rolled round an upright cylinder, isometrically.
Cloth rolled_sheet(double edge, double radius) {
  const int columns = static_cast<int>(std::lround(0.2 / edge));
  const int rows = static_cast<int>(std::lround(0.2 / (edge * std::sqrt(3.0) / 2)));
  return equilateral_sheet(columns, rows, edge, suiting(), [&](const Vec2& uv) {
    return Vec3(radius * std::sin(uv.x() / radius), uv.y(), radius * std::cos(uv.x() / radius));
  });
}

TEST(DiscretisationError, OfACylinderIsOfSecondOrder) {
  for (const double radius : {0.05, 0.2}) {
    double before = 0;
    for (const double edge : {0.01, 0.005}) {
      const double chord = edge * edge / radius / 16, ours = discretisation_error(rolled_sheet(edge, radius), {});
      // A bent lattice's hinges show a little curvature along the axis, of second order as well.
      EXPECT_GT(ours, 0.9 * chord) << radius << " " << edge;
      EXPECT_LT(ours, 2 * chord) << radius << " " << edge;
      if (before > 0) {
        EXPECT_NEAR(std::log2(before / ours), 2, 0.1) << radius;
      }
      before = ours;
    }
  }
}

TEST(DiscretisationError, OfABallItIsOfFirstOrderDownToEdgesOfTheBendingLength) {
  const double radius = 2;
  Fabric fabric = suiting();
  for (const double length : {0.02, 0.004})
    for (const double edge : {0.01, 0.005}) {
      const double d = fabric.area_density * kGravity * std::pow(length, 3);
      fabric.bending_stiffness = {d, d, d};
      const int columns = static_cast<int>(std::lround(0.4 / edge));
      const Cloth sheet = equilateral_sheet(columns, columns, edge, fabric, [&](const Vec2& uv) {
        return Vec3(uv.x(), uv.y(), -0.5 * uv.squaredNorm() / radius);
      });
      const double chord = edge * edge * std::sqrt(2.0) / radius / 16;
      const double fold = kFoldErrorFactor * edge * std::max(edge, length) / radius;
      // The sheet is a little shallower than the paraboloid towards its rim, which has no share in the folds.
      EXPECT_NEAR(discretisation_error(sheet, {}), chord + fold, (0.05 + 4 * edge / 0.4) * (chord + fold))
          << length << " " << edge;
    }
}

TEST(DiscretisationError, AFlatSheetHasNone) {
  EXPECT_EQ(discretisation_error(equilateral_sheet(10, 10, 0.01, suiting()), {}), 0);
}

TEST(DiscretisationError, WhatLiesOnTheBodyIsOffItByTheContactDistance) {
  const Cloth sheet = equilateral_sheet(10, 10, 0.01, suiting());
  std::vector<Contact> contacts;
  for (std::size_t v = 0; v < sheet.x.size(); ++v) {
    Contact c;
    c.nodes = {static_cast<int>(v), 0, 0, 0};
    c.weights = {1, 0, 0, 0};
    c.count = 1;
    c.normal = Vec3::UnitY();
    c.offset = -0.9e-3;
    c.distance = 1e-3;
    contacts.push_back(c);
  }
  EXPECT_NEAR(discretisation_error(sheet, contacts), 1e-3 - 0.5 * suiting().thickness, 1e-9);
  for (Contact& c : contacts) c.offset = -1.1e-3;  // near, but does not press
  EXPECT_EQ(discretisation_error(sheet, contacts), 0);
}

}  // namespace
}  // namespace toile
