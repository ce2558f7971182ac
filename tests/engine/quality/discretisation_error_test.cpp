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

TEST(DiscretisationError, OfACylinderIsItsCurvatureTimesTheSquareOfTheEdge) {
  for (const double radius : {0.05, 0.2})
    for (const double edge : {0.01, 0.005}) {
      const double expected = kShapeErrorFactor * edge * edge / radius;
      // The rim's missing hinges and half triangles are of the order of edge / width.
      EXPECT_NEAR(discretisation_error(rolled_sheet(edge, radius), {}), expected, 2 * edge / 0.2 * expected)
          << radius << " " << edge;
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
