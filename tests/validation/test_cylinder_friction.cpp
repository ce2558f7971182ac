// Strips over a horizontal cylinder: the heavy one against the integrated balance of a heavy rope, the light one with
// weights at its ends against the capstan's exp(mu phi). The threshold is found by halving.

#include "engine/solve/simulate.h"
#include "tests/engine/solve/scenes.h"
#include "tests/validation/references.h"

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kContactOffset = 5e-4;  ///< contact offset; the mid-surface lies at `radius` [m]
constexpr double kRowHeight = 0.01;

/// Strip of two cells' width whose length runs over the cylinder, `shorter` hanging on one side, `longer` on the other.
struct OverCylinder {
  double radius, shorter, longer, friction, density;
  double shorter_end_density = 0, longer_end_density = 0;  ///< of the last two rows of cells, where not 0 [kg/m²]
};

/// How far the strip moves towards its longer side between two times [m].
double slip(const OverCylinder& setup, double from, double to) {
  const double around = std::numbers::pi * setup.radius, length = setup.shorter + around + setup.longer;
  const int rows = static_cast<int>(std::lround(length / kRowHeight));
  const double height = length / rows, edge = height * 2 / std::sqrt(3.0);
  const double top = setup.shorter + 0.5 * around, r = setup.radius - 1e-6;
  Fabric fabric = isotropic_fabric(setup.density, 2000, 500, 0, 1e-6);
  Cloth strip = equilateral_sheet(2, rows, edge, fabric, [&](const Vec2& uv) -> Vec3 {
    const double s = uv.y() - top;
    if (std::abs(s) <= 0.5 * around) return {r * std::sin(s / r), r * std::cos(s / r), uv.x()};
    return {std::copysign(r, s), 0.5 * around - std::abs(s), uv.x()};
  });
  const std::array<double, 2> end_density = {setup.shorter_end_density, setup.longer_end_density};
  for (int end = 0; end < 2; ++end) {
    if (end_density[end] == 0) continue;
    strip.fabrics.push_back(fabric);
    strip.fabrics.back().area_density = end_density[end];
    strip.panels.push_back(strip.panels[0]);
    strip.panels.back().fabric = static_cast<int>(strip.fabrics.size()) - 1;
    for (std::size_t t = 0; t < strip.triangles.size(); ++t) {
      double middle = 0;
      for (const Vec2& corner : strip.flat[t]) middle += corner.y() / 3;
      if (end == 0 ? middle < 2 * height : middle > length - 2 * height)
        strip.triangle_panel[t] = static_cast<int>(strip.panels.size()) - 1;
    }
  }
  const Body body{CylinderBody{Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), setup.radius - kContactOffset}, setup.friction};
  const BodyField field = make_body_field(body, 0.01);
  SimulationScene scene;
  scene.body = &field;
  scene.body_friction = setup.friction;
  scene.options.body_offset = kContactOffset;
  scene.options.relaxation_time = 0;
  scene.options.early_stop = false;
  scene.options.simulated_time_limit = to;
  const std::size_t watched = strip.x.size() - 1;  // on the longer side's end
  double then = 0;
  bool seen = false;
  simulate(strip, scene, [&](const SimulationState& state) {
    if (!seen && state.time >= from) then = (*state.x)[watched].y(), seen = true;
    return true;
  });
  return then - strip.x[watched].y();
}

constexpr double kSlid = 1e-3;  ///< [m] in the time observed; a strip that sticks moves by micrometres

}  // namespace

class HeavyStripReference : public testing::TestWithParam<int> {};

TEST_P(HeavyStripReference, SlidesWhereTheLongerSideOutweighsFriction) {
  SKIP_WITHOUT_REFERENCES();
  const std::string at = "/friction/cylinder/" + std::to_string(GetParam());
  const double critical = reference(at + "/L2_critical");
  OverCylinder setup{reference(at + "/R"), reference(at + "/L1"), 0, reference(at + "/mu"), 0.2};
  double low = 0.94, high = 1.06;
  for (int k = 0; k < 3; ++k) {
    const double middle = 0.5 * (low + high);
    setup.longer = middle * critical;
    (slip(setup, 0.5, 1.0) > kSlid ? high : low) = middle;
  }
  const double ours = 0.5 * (low + high) * critical;
  std::cout << "friction " << setup.friction << ", longer side at the threshold: reference " << critical << " m, ours "
            << ours << ", error " << 100 * (ours / critical - 1) << " %\n";
  EXPECT_NEAR(ours, critical, 0.05 * critical);
}

INSTANTIATE_TEST_SUITE_P(Rows, HeavyStripReference, testing::Values(0, 1, 2));

TEST(CapstanReference, SlidesAtTheExponential) {
  for (double friction : {0.1, 0.3, 0.5}) {
    // The strip itself weighs a hundredth of what hangs on it.
    const double critical = std::exp(friction * std::numbers::pi), load = 20;
    double low = 0.94, high = 1.06;
    for (int k = 0; k < 4; ++k) {
      const double middle = 0.5 * (low + high);
      const OverCylinder setup{0.1, 0.06, 0.06, friction, 0.01, load, load * middle * critical};
      (slip(setup, 0.3, 0.5) > kSlid ? high : low) = middle;
    }
    const double ours = 0.5 * (low + high) * critical;
    std::cout << "friction " << friction << ", ratio of forces at the threshold: reference " << critical << ", ours "
              << ours << ", error " << 100 * (ours / critical - 1) << " %\n";
    EXPECT_NEAR(ours, critical, 0.05 * critical);
  }
}
