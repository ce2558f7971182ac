#include "engine/quality/measure.h"

#include "engine/parallel/state_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace toile {
namespace {

/// A flat square of 0.2 m in two triangles, stretched by 1.1 along weft (x) and 1.02 along warp (z), at height y.
Cloth square(double y) {
  Cloth cloth;
  const std::vector<Vec2> flat{Vec2(0, 0), Vec2(0.2, 0), Vec2(0.2, 0.2), Vec2(0, 0.2)};
  for (const Vec2& p : flat) cloth.x.push_back({1.1 * p.x(), y, 1.02 * p.y()});
  for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 2, 3}}) {
    cloth.triangles.push_back(t);
    cloth.flat.push_back({flat[t[0]], flat[t[1]], flat[t[2]]});
    cloth.triangle_panel.push_back(0);
  }
  cloth.vertex_garment.assign(4, 0);
  cloth.panels.resize(1);
  cloth.fabrics.resize(1);
  return cloth;
}

TEST(MeasureGeometry, FillsWhatTheFinalStateShowsAndNothingElse) {
  const Cloth cloth = square(0.095);
  const BodyField ball = make_body_field({SphereBody{Vec3(0.11, 0, 0.1), 0.1}, 0.3}, 0.02);
  Report report;
  report.status = "converged";
  report.steps = 12;
  report.residual_rms = 0.5;
  report.kinetic_energy = 3;
  report.seam_gap_max = 1e-4;
  measure_geometry(cloth, &ball, report);
  EXPECT_EQ(report.vertices, 4);
  EXPECT_EQ(report.triangles, 2);
  for (double value : {report.stretch_weft.mean, report.stretch_weft.p99, report.stretch_weft.max})
    EXPECT_NEAR(value, 0.1, 1e-12);
  for (double value : {report.stretch_warp.mean, report.stretch_warp.p99, report.stretch_warp.max})
    EXPECT_NEAR(value, 0.02, 1e-12);
  for (double value : {report.stretch_bias.min, report.stretch_bias.median, report.stretch_bias.max})
    EXPECT_NEAR(value, std::sqrt((1.1 * 1.1 + 1.02 * 1.02) / 2) - 1, 1e-12);
  EXPECT_EQ(report.compressed_share, 0);
  EXPECT_NEAR(report.penetration_max, 0.005, 2e-4);
  EXPECT_EQ(report.self_intersections, 0);
  EXPECT_EQ(report.result_sha256, sha256_hex(cloth.x));
  EXPECT_EQ(report.status, "converged");
  EXPECT_EQ(report.steps, 12);
  EXPECT_EQ(report.residual_rms, 0.5);
  EXPECT_EQ(report.kinetic_energy, 3);
  EXPECT_EQ(report.seam_gap_max, 1e-4);
}

TEST(MeasureGeometry, SaysHowMuchIsSqueezedBeyondTheModel) {
  Cloth cloth = square(0);
  cloth.x[1].x() *= 0.3;  // squeezes one of the two triangles along weft
  Report report;
  measure_geometry(cloth, nullptr, report);
  EXPECT_NEAR(report.compressed_share, 0.5, 1e-12);
}

TEST(MeasureGeometry, WithoutABodyNothingIsInsideIt) {
  Report report;
  measure_geometry(square(0), nullptr, report);
  EXPECT_EQ(report.penetration_max, 0);
}

TEST(MeasureGeometry, CountsPairsThatCross) {
  Cloth cloth = square(0);
  const Cloth above = square(0);
  for (const Vec3& p : above.x) cloth.x.push_back(Vec3(p.x(), p.z() - 0.05, 0.1 + 1e-3 * p.x()));  // stands across it
  for (std::size_t t = 0; t < 2; ++t) {
    cloth.triangles.push_back({above.triangles[t][0] + 4, above.triangles[t][1] + 4, above.triangles[t][2] + 4});
    cloth.flat.push_back(above.flat[t]);
    cloth.triangle_panel.push_back(0);
  }
  Report report;
  measure_geometry(cloth, nullptr, report);
  EXPECT_GE(report.self_intersections, 2);
  EXPECT_LE(report.self_intersections, 4);
}

TEST(MeasureResidual, IsTheNetForceOverTheNodalWeight) {
  const std::vector<double> mass{1, 2, 1, 0};
  const Positions force{Vec3(0, 0.1 * kGravity, 0), Vec3(0.6 * kGravity, 0, 0), Vec3(9, 9, 9), Vec3(7, 7, 7)};
  Report report;
  measure_residual(force, mass, {0, 0, 1, 0}, report);  // the third is held, the fourth has no mass
  EXPECT_NEAR(report.residual_rms, std::sqrt((0.01 + 0.09) / 2), 1e-12);
  EXPECT_NEAR(report.residual_max, 0.3, 1e-12);
  measure_residual({Vec3(1, 1, 1)}, {1}, {1}, report);  // nothing is free
  EXPECT_EQ(report.residual_rms, 0);
  EXPECT_EQ(report.residual_max, 0);
}

}  // namespace
}  // namespace toile
