// Two sheets of different fabrics on a plane: where they come to lie, and at which slope each of them slides.

#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kEdge = 0.01;

/// A thin sheet on a plane, a thick and smaller one on its middle; each with its fabric and panel.
Cloth two_layers(const Vec3& normal, const Vec3& downhill, double lower, double upper) {
  Fabric thin = suiting(), thick = suiting();
  thin.name = "thin";
  thin.thickness = 1e-3;
  thick.name = "thick";
  thick.thickness = 2.4e-3;
  thin.friction_cloth = thick.friction_cloth = 0.3;
  const auto at = [&](double size, double height) {
    return [&, size, height](const Vec2& uv) -> Vec3 {
      return (uv.x() - 0.5 * size) * downhill + (uv.y() - 0.5 * size) * Vec3::UnitZ() + height * normal;
    };
  };
  Cloth both = equilateral_sheet(10, 12, kEdge, thin, at(0.1, lower));
  const Cloth over = equilateral_sheet(7, 8, kEdge, thick, at(0.07, upper));
  const int first = static_cast<int>(both.x.size());
  both.x.insert(both.x.end(), over.x.begin(), over.x.end());
  both.flat.insert(both.flat.end(), over.flat.begin(), over.flat.end());
  for (Triangle t : over.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  both.triangle_panel.resize(both.triangles.size(), 1);
  both.vertex_garment.resize(both.x.size(), 1);
  both.fabrics.push_back(thick);
  both.panels.push_back(over.panels[0]);
  both.panels[1].fabric = 1;
  both.panels[1].garment = 1;
  return both;
}

struct Layers {
  double lower_height = 0, upper_height = 0;  ///< means over the plane [m]
  double lower_slip = 0, upper_slip = 0;      ///< downhill in the last half second [m]
};

Layers settle(double slope, double body_friction, const std::vector<FrictionPair>& pairs) {
  const Vec3 normal(std::sin(slope), std::cos(slope), 0), downhill(std::cos(slope), -std::sin(slope), 0);
  Cloth cloth = two_layers(normal, downhill, 0.999e-3, 3.0e-3);
  const BodyField plane = make_body_field({PlaneBody{Vec3::Zero(), normal}, 0.3}, 0.02);
  SimulationScene scene;
  scene.body = &plane;
  scene.body_friction = body_friction;
  scene.friction_pairs = pairs;
  scene.options.early_stop = false;
  scene.options.air_drag = 1;
  scene.options.simulated_time_limit = 1.0;
  const std::size_t split = static_cast<std::size_t>(
      std::find(cloth.vertex_garment.begin(), cloth.vertex_garment.end(), 1) - cloth.vertex_garment.begin());
  // The lattice's half triangles along its border limit the distance there: heights count away from it.
  const Positions start = cloth.x;
  const auto mean = [&](const Positions& x, bool upper, const Vec3& along) {
    double sum = 0;
    int count = 0;
    for (std::size_t v = upper ? split : 0; v < (upper ? x.size() : split); ++v) {
      if (std::max(std::abs(start[v].dot(downhill)), std::abs(start[v].z())) > 0.021) continue;
      sum += x[v].dot(along);
      ++count;
    }
    return sum / count;
  };
  Positions then;
  simulate(cloth, scene, [&](const SimulationState& state) {
    if (then.empty() && state.time >= 0.5) then = *state.x;
    return true;
  });
  return {mean(cloth.x, false, normal), mean(cloth.x, true, normal),
          mean(cloth.x, false, downhill) - mean(then, false, downhill),
          mean(cloth.x, true, downhill) - mean(then, true, downhill)};
}

}  // namespace

TEST(LayersReference, FabricsLieHalfTheSumOfTheirDistancesApart) {
  const Layers ours = settle(0, 0.3, {});
  // 10 mm edges want 1.8 mm between layers of the thin fabric, the thick one its 2.4 mm; half of each is 2.1 mm.
  std::cout << "lower sheet over the plane: reference 1.000 mm, ours " << 1e3 * ours.lower_height
            << " mm\nbetween the sheets: reference 2.100 mm, ours " << 1e3 * (ours.upper_height - ours.lower_height)
            << " mm\n";
  EXPECT_NEAR(ours.lower_height, 1.0e-3, 0.05e-3);
  EXPECT_NEAR(ours.upper_height - ours.lower_height, 2.1e-3, 0.1e-3);
}

TEST(LayersReference, EachPairSlidesAtItsOwnAngle) {
  const double slope = std::atan(0.3);
  constexpr double kMoved = 5e-3, kStill = 1e-4;  // [m] in half a second
  const Layers both_hold = settle(slope, 0.4, {{"thin", "thick", 0.4}});
  EXPECT_LT(std::abs(both_hold.lower_slip), kStill);
  EXPECT_LT(std::abs(both_hold.upper_slip), kStill);
  const Layers upper_slides = settle(slope, 0.4, {{"thick", "thin", 0.2}});
  EXPECT_LT(std::abs(upper_slides.lower_slip), kStill);
  EXPECT_GT(upper_slides.upper_slip, kMoved);
  const Layers both_slide = settle(slope, 0.4, {{"thin", "thick", 0.4}, {"thin", "", 0.2}});
  EXPECT_GT(both_slide.lower_slip, kMoved);
  EXPECT_NEAR(both_slide.upper_slip, both_slide.lower_slip, 1e-3);
}
