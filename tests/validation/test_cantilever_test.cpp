// The cantilever test as an experiment of the laboratory, against the elastica: an elastic strip's bending length is
// that of its stiffness, in each direction, and a given overhang falls by the reference's angle.

#include "engine/experiments/cantilever.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/references.h"
#include "tests/validation/silent.h"

#include <cstdio>

using namespace toile;
using namespace toile::test;

namespace {

/// Of 0.2 kg/m², warp and weft pliable enough to ask of each its own strip.
Fabric fabric(const Directional& bending) {
  Fabric f = isotropic_fabric(0.2, 1000, 500, 0, 0);
  f.bending_stiffness = bending;
  return f;
}

/// A strip on the bias bends along itself alone where warp is as stiff as weft; else it twists, too.
constexpr Directional kOblong = {8e-6, 2e-6, 5e-6}, kSquare = {8e-6, 8e-6, 5e-6};

}  // namespace

TEST(CantileverTest, FindsTheBendingLengthOfEachDirection) {
  Silent monitor;
  for (const auto& [bending, direction, name, stiffness] : {std::tuple{kOblong, Direction::warp, "warp", 8e-6},
                                                            {kOblong, Direction::weft, "weft", 2e-6},
                                                            {kSquare, Direction::bias, "bias", 5e-6}}) {
    const double expected = std::cbrt(stiffness / (0.2 * kGravity));
    const CantileverResult ours = bend_over({fabric(bending), direction}, 1, monitor);
    ASSERT_TRUE(ours.report.bending_length) << name;
    std::printf("bending length %s: reference %.3f mm, ours %.3f mm, error %.2f %%; chord at %.2f degrees\n", name,
                1e3 * expected, 1e3 * *ours.report.bending_length, 100 * (*ours.report.bending_length / expected - 1),
                ours.report.angle * 180 / std::numbers::pi);
    // The rows of triangles along the free edges bend too easily across them, most on the bias: 2 % at a twelfth.
    EXPECT_NEAR(*ours.report.bending_length, expected, 0.025 * expected) << name;
    EXPECT_EQ(ours.drape.report.status, "converged");
  }
}

TEST(CantileverTest, GivenOverhangFallsByTheReferencesAngle) {
  SKIP_WITHOUT_REFERENCES();
  Silent monitor;
  for (const double gamma : {1.0, 20.0}) {
    const std::string at = "/cantilever/" + std::to_string(reference_row("/cantilever", "Gamma", gamma));
    const double expected = std::atan2(reference(at + "/drop"), reference(at + "/x")) * 180 / std::numbers::pi;
    Cantilever test{fabric(kOblong), Direction::warp};
    test.overhang = std::cbrt(gamma * 8e-6 / (0.2 * kGravity));
    test.width = 0.01;
    test.edge_length = *test.overhang / 20;
    const CantileverResult result = bend_over(test, 1, monitor);
    const double ours = result.report.angle * 180 / std::numbers::pi;
    std::printf("Gamma %g: chord at %.2f degrees, reference %.2f\n", gamma, ours, expected);
    EXPECT_NEAR(ours, expected, 0.5);
    EXPECT_FALSE(result.report.bending_length);
  }
}

TEST(CantileverTest, StripTooStiffToFallIsNotConverged) {
  Silent monitor;
  Cantilever board{fabric({0.09, 0.09, 0.09}), Direction::warp};
  board.fabric.area_density = 1e-3;
  board.edge_length = 0.1;
  EXPECT_EQ(bend_over(board, 1, monitor).drape.report.status, "not_converged");
}
