#include "engine/solve/clear_panels.h"

#include "engine/scene/problem.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

constexpr double kClearance = 3e-3;

struct Placed {
  explicit Placed(const Pattern& pattern, const Body& body = cylinder_body(), double edge = 0.03)
      : whole(make_body_field(body, edge)) {
    scene.garments = {garment_of(pattern, edge)};
    scene.body = body;
    cloth = build_cloth(scene);
  }
  void clear(double reach = 0.4) {
    clear_panels(cloth, field_of_vertices(cloth, {&whole, nullptr}), kClearance, reach);
  }
  double nearest() const {
    double d = 1;
    for (const Vec3& p : cloth.x) d = std::min(d, whole.distance(p));
    return d;
  }
  std::vector<Vec3> moves(const Positions& before, int panel) const {
    std::vector<Vec3> result;
    for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
      if (cloth.triangle_panel[t] == panel)
        for (int v : cloth.triangles[t]) result.push_back(cloth.x[v] - before[v]);
    return result;
  }
  Scene scene;
  BodyField whole;
  Cloth cloth;
};

TEST(ClearPanels, PanelsThatAreFreeStay) {
  Placed placed(tube_pattern(0.36, 0.15, 0.16, -0.1));
  const Positions before = placed.cloth.x;
  placed.clear();
  EXPECT_EQ(placed.cloth.x, before);
  EXPECT_TRUE(placed.cloth.warnings.empty());
}

TEST(ClearPanels, APanelInsideTheBodyMovesOutAlongItsNormalAndOnlyIt) {
  Pattern pattern = tube_pattern(0.36, 0.15, 0.16, -0.1);
  pattern.panels[0].translation.z() = 0.06;  // 40 mm deep
  Placed placed(pattern);
  const Positions before = placed.cloth.x;
  ASSERT_LT(placed.nearest(), -0.03);
  placed.clear();
  EXPECT_GE(placed.nearest(), kClearance);
  for (const Vec3& move : placed.moves(before, 0)) {
    EXPECT_LT((move - Vec3(0, 0, move.z())).norm(), 1e-12);
    EXPECT_GE(move.z(), 0.04 + kClearance - 1e-12);
    EXPECT_LE(move.z(), 0.04 + kClearance + 0.011);  // no farther than it has to
  }
  for (const Vec3& move : placed.moves(before, 1)) EXPECT_EQ(move, Vec3(0, 0, 0));
  ASSERT_EQ(placed.cloth.warnings.size(), 1u);
  EXPECT_NE(placed.cloth.warnings[0].find("front"), std::string::npos);
}

TEST(ClearPanels, ABodyThatOnlyPiercesAPanelsMiddleIsSeen) {
  Pattern pattern{{around_axis(rectangle_panel("sheet", 0.3, 0.3), 0, 0.0, -0.15)}, {}};
  Placed placed(pattern, {SphereBody{Vec3(0.001, 0.002, -0.001), 0.03}, 0.3}, 0.1);  // less than an edge across
  placed.clear();
  EXPECT_GT(placed.cloth.x[0].z(), 0.02);
}

TEST(ClearPanels, OfTwoPanelsThatCrossTheLaterMoves) {
  Pattern pattern = tube_pattern(0.36, 0.15, 0.16, -0.1);
  Panel across = around_axis(rectangle_panel("across", 0.1, 0.1), 0, 0.16, -0.05);
  across.rotation = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  pattern.panels.push_back(across);
  Placed placed(pattern);
  ASSERT_GT(self_intersections(placed.cloth.x, placed.cloth.triangles).size(), 0u);
  const Positions before = placed.cloth.x;
  placed.clear();
  EXPECT_EQ(self_intersections(placed.cloth.x, placed.cloth.triangles).size(), 0u);
  for (const Vec3& move : placed.moves(before, 0)) EXPECT_EQ(move, Vec3(0, 0, 0));
  EXPECT_GT(placed.moves(before, 2)[0].norm(), 0);
}

TEST(ClearPanels, APanelWithoutAFreePlaceIsRefusedByName) {
  Placed placed(tube_pattern(0.36, 0.15, 0.16, -0.1), {SphereBody{Vec3::Zero(), 2.0}, 0.3});
  try {
    placed.clear();
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "panel_inside_body");
    EXPECT_EQ(error.problems()[0].pointer.rfind("/garments/0", 0), 0u);
    EXPECT_NE(error.problems()[0].detail.find("front"), std::string::npos);
  }
}

TEST(FieldOfVertices, OnlyPanelsOfLegsIgnoreWhatHangs) {
  Pattern pattern = tube_pattern(0.36, 0.15, 0.16, -0.1);
  pattern.panels[1].label = "leg";
  const Placed placed(pattern);
  const BodyField other = placed.whole;
  const auto field = field_of_vertices(placed.cloth, {&placed.whole, &placed.whole, &other});
  for (std::size_t t = 0; t < placed.cloth.triangles.size(); ++t)
    for (int v : placed.cloth.triangles[t])
      EXPECT_EQ(field[v], placed.cloth.triangle_panel[t] ? &other : &placed.whole);
  for (const BodyField* f : field_of_vertices(placed.cloth, {&placed.whole, &other, nullptr}))
    EXPECT_EQ(f, &placed.whole);
  for (const BodyField* f : field_of_vertices(placed.cloth, {})) EXPECT_EQ(f, nullptr);
}

/// Two squares that share the line x = 0 as drawn, with a vertex each at every place along it.
Cloth slit_sheet() {
  Scene scene;
  Panel left = rectangle_panel("left", 0.1, 0.1), right = left;
  right.name = "right";
  left.translation.x() = -0.05;
  right.translation.x() = 0.05;
  scene.garments = {garment_of(Pattern{{left, right}, {}}, 0.02)};
  return build_cloth(scene);
}

TEST(OpenSlits, EdgesThatLieOnOneAnotherComeApart) {
  Cloth cloth = slit_sheet();
  const Positions before = cloth.x;
  ASSERT_GT(self_intersections(cloth.x, cloth.triangles).size(), 0u);
  open_slits(cloth, 2e-4);
  EXPECT_EQ(self_intersections(cloth.x, cloth.triangles).size(), 0u);
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double move = (cloth.x[v] - before[v]).norm();
    EXPECT_LE(move, 2.0001e-4);
    if (std::abs(before[v].x()) > 0.035) {  // beyond the triangles that touch the slit
      EXPECT_EQ(move, 0) << before[v].transpose();
    }
  }
}

TEST(RefuseCoincident, LayersInOneAndTheSamePlace) {
  Scene scene;
  const Panel square = rectangle_panel("square", 0.1, 0.1);
  for (const char* name : {"first", "second"}) scene.garments.push_back(garment_of(Pattern{{square}, {}}, 0.02, name));
  try {
    refuse_coincident(build_cloth(scene));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].code, "coincident_layers");
    EXPECT_EQ(error.problems()[0].pointer, "/garments/0");
  }
  std::get<Pattern>(scene.garments[1].shape).panels[0].translation.z() += 1e-6;
  EXPECT_NO_THROW(refuse_coincident(build_cloth(scene)));
}

TEST(RefuseCoincident, EdgesSideBySideThatWereOpened) {
  Cloth cloth = slit_sheet();
  EXPECT_THROW(refuse_coincident(cloth), InputError);
  open_slits(cloth, 1e-5);
  EXPECT_NO_THROW(refuse_coincident(cloth));
}

TEST(OpenSlits, AFlatSheetStaysAsItIs) {
  Cloth cloth = equilateral_sheet(6, 6, 0.02, suiting());
  const Positions before = cloth.x;
  open_slits(cloth, 2e-4);
  EXPECT_EQ(cloth.x, before);
}

}  // namespace
}  // namespace toile
