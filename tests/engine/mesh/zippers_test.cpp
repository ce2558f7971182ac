#include "engine/mesh/zippers.h"

#include "engine/mesh/build_cloth.h"
#include "engine/mesh/sewing.h"
#include "engine/scene/check.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

namespace toile {
namespace {

using namespace test;

Scene zipped(double closed_fraction) { return zipped_halves(0.1, 0.2, 0.19, 2e-3, closed_fraction); }

std::string zipper_problem_of(const Scene& scene) {
  try {
    check_scene(scene);
  } catch (const InputError& error) {
    return error.problems()[0].code + " " + error.problems()[0].pointer;
  }
  return "none";
}

TEST(Zippers, BothSidesHaveAsManyVerticesAndTheClosedOnesBecomeOne) {
  for (const double fraction : {0.0, 0.6, 0.63, 1.0}) {
    Cloth cloth = build_cloth(zipped(fraction));
    const auto apart = zipper_sides(cloth, 0, 0);
    ASSERT_EQ(apart[0].size(), 11u);  // 200 mm in edges of 20, and the other side's 190 as well
    ASSERT_EQ(apart[1].size(), 11u);
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 1; i < 11; ++i)
        EXPECT_GT(cloth.x[static_cast<std::size_t>(apart[k][i])].y(),
                  cloth.x[static_cast<std::size_t>(apart[k][i - 1])].y());
    merge_seams(cloth);
    const auto sewn = zipper_sides(cloth, 0, 0);
    const std::size_t closed = fraction == 0 ? 0 : 1 + static_cast<std::size_t>(std::lround(10 * fraction));
    for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(sewn[0][i] == sewn[1][i], i < closed) << fraction << ' ' << i;
  }
}

TEST(Zippers, MayCloseFromTheTop) {
  Scene scene = zipped(0.5);
  scene.garments[0].zippers[0].from_end = true;
  Cloth cloth = build_cloth(scene);
  const auto sides = zipper_sides(cloth, 0, 0);
  EXPECT_NEAR(cloth.x[static_cast<std::size_t>(sides[0][0])].y(), 0.2, 1e-12);
  EXPECT_NEAR(cloth.x[static_cast<std::size_t>(sides[1][0])].y(), 0.19, 1e-12);
}

TEST(Zippers, OfAMeshNamesItsVertices) {
  Scene scene = zipped_mesh(zipped(0));
  Zipper& zipper = scene.garments[0].zippers[0];
  zipper.closed_fraction = 0.6;
  EXPECT_EQ(zipper_problem_of(scene), "none");
  Cloth sewn = build_cloth(scene);
  EXPECT_EQ(sewn.seam_pairs.size(), 7u);
  zipper.sides[1] = PinVertices{{0, 1}};
  EXPECT_EQ(zipper_problem_of(scene), "zipper_side /garments/0/zippers/0/sides");
  zipper.sides[1] = PinEdge{1, 3};
  EXPECT_EQ(zipper_problem_of(scene), "zipper_side /garments/0/zippers/0/sides/1");
}

TEST(Zippers, AnEdgeIsSewnOnce) {
  Scene scene = zipped(0.5);
  EXPECT_EQ(zipper_problem_of(scene), "none");
  scene.garments[0].zippers.push_back(scene.garments[0].zippers[0]);
  EXPECT_EQ(zipper_problem_of(scene), "edge_stitched_twice /garments/0/zippers/1/sides/0");
  scene = zipped(0.5);
  std::get<Pattern>(scene.garments[0].shape).stitches = {{{0, 1}, {1, 1}, false}};
  EXPECT_EQ(zipper_problem_of(scene), "edge_stitched_twice /garments/0/zippers/0/sides/0");
}

TEST(Zippers, NumbersOutOfRangeAreNamed) {
  Scene scene = zipped(1.2);
  EXPECT_EQ(zipper_problem_of(scene), "zipper_value /garments/0/zippers/0/closed_percent");
  scene = zipped(0.5);
  scene.garments[0].zippers[0].slider.mass = 0;
  EXPECT_EQ(zipper_problem_of(scene), "zipper_value /garments/0/zippers/0/slider");
}

}  // namespace
}  // namespace toile
