#include "engine/geometry/body_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace toile {
namespace {

BodyField field_of(auto shape) { return make_body_field(Body{shape, 0.3}, 0.015); }

/// The gradient is the normal, its length is one, the distance is that to the surface along it.
void expect_exact(const BodyField& field, const Vec3& p) {
  const BodyField::Sample s = field.sample(p);
  EXPECT_NEAR(s.normal.norm(), 1, 1e-12);
  EXPECT_DOUBLE_EQ(field.distance(p), s.distance);
  EXPECT_NEAR(field.distance(p - s.distance * s.normal), 0, 1e-12);
  if (s.distance > 0) {
    EXPECT_NEAR(field.distance(p + 0.1 * s.normal), s.distance + 0.1, 1e-12);
  }
}

double enclosed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  return volume;
}

TEST(PrimitiveField, ClosedForms) {
  const BodyField sphere = field_of(SphereBody{Vec3(1, 2, 3), 0.5});
  EXPECT_DOUBLE_EQ(sphere.distance({1, 2, 5}), 1.5);
  EXPECT_DOUBLE_EQ(sphere.distance({1, 2, 3}), -0.5);
  const BodyField capsule = field_of(CapsuleBody{Vec3(0, 0, 0), Vec3(0, 2, 0), 0.3});
  EXPECT_DOUBLE_EQ(capsule.distance({1, 1, 0}), 0.7);
  EXPECT_DOUBLE_EQ(capsule.distance({0, 3, 0}), 0.7);
  const BodyField cylinder = field_of(CylinderBody{Vec3(0, 0, 0), Vec3(0, 2, 0), 0.3});
  EXPECT_DOUBLE_EQ(cylinder.distance({0, 3, 0}), 1);
  EXPECT_DOUBLE_EQ(cylinder.distance({0.6, 2.4, 0}), 0.5);
  EXPECT_DOUBLE_EQ(cylinder.distance({0.1, 1, 0}), -0.2);
  const BodyField box = field_of(BoxBody{Vec3::Zero(), Vec3(1, 2, 3), Mat3::Identity()});
  EXPECT_DOUBLE_EQ(box.distance({4, 6, 0}), 5);
  EXPECT_DOUBLE_EQ(box.distance({0.5, 0, 0}), -0.5);
  const BodyField plane = field_of(PlaneBody{Vec3(0, 1, 0), Vec3(0, 2, 0)});
  EXPECT_DOUBLE_EQ(plane.distance({5, 3, 5}), 2);
  EXPECT_EQ(plane.sample({5, 3, 5}).normal, Vec3::UnitY());
}

TEST(PrimitiveField, NormalsAreGradientsAtRandomPoints) {
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const std::vector<BodyField> fields{
      field_of(SphereBody{Vec3(0.1, 0, 0.2), 0.5}),
      field_of(CapsuleBody{Vec3(-0.5, 0, 0.1), Vec3(0.4, 0.3, 0), 0.2}),
      field_of(CylinderBody{Vec3(-0.5, 0, 0.1), Vec3(0.4, 0.3, 0), 0.3}),
      field_of(BoxBody{Vec3(0.1, 0.2, 0), Vec3(0.3, 0.2, 0.5), turn}),
      field_of(PlaneBody{Vec3(0, 0.3, 0), Vec3(0.1, 1, 0.2)}),
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  for (const BodyField& field : fields) {
    for (int i = 0; i < 500; ++i) expect_exact(field, {place(random), place(random), place(random)});
  }
}

TEST(PrimitiveField, MedialPointsHaveANormal) {
  const auto expect_unit = [](const BodyField& field, const Vec3& p) {
    const BodyField::Sample s = field.sample(p);
    EXPECT_TRUE(s.normal.allFinite());
    EXPECT_NEAR(s.normal.norm(), 1, 1e-12);
    EXPECT_TRUE(std::isfinite(s.distance));
  };
  expect_unit(field_of(SphereBody{Vec3::Zero(), 1}), Vec3::Zero());
  expect_unit(field_of(CapsuleBody{Vec3::Zero(), Vec3(0, 1, 0), 0.2}), Vec3(0, 0.5, 0));
  expect_unit(field_of(CylinderBody{Vec3::Zero(), Vec3(0, 1, 0), 0.2}), Vec3(0, 0.5, 0));
  expect_unit(field_of(BoxBody{Vec3::Zero(), Vec3(1, 1, 1), Mat3::Identity()}), Vec3::Zero());
  expect_unit(field_of(BoxBody{Vec3::Zero(), Vec3(1, 1, 1), Mat3::Identity()}), Vec3(1, 1, 1));
}

TEST(PrimitiveField, SurfacesLieOnTheBodyAndFaceOutwards) {
  const double pi = std::numbers::pi;
  const std::vector<std::pair<BodyField, double>> fields{
      {field_of(SphereBody{Vec3(0.1, 0, 0.2), 0.5}), 4 * pi / 3 * 0.125},
      {field_of(CapsuleBody{Vec3(0, 0, 0), Vec3(0.3, 0.4, 0), 0.2}), pi * 0.04 * 0.5 + 4 * pi / 3 * 0.008},
      {field_of(CylinderBody{Vec3(0, 0, 0), Vec3(0.3, 0.4, 0), 0.2}), pi * 0.04 * 0.5},
      {field_of(BoxBody{Vec3(0.1, 0.2, 0), Vec3(0.3, 0.2, 0.5), Mat3::Identity()}), 0.24},
  };
  for (const auto& [field, volume] : fields) {
    const TriangleMesh mesh = field.surface();
    EXPECT_NEAR(enclosed_volume(mesh), volume, 0.01 * volume);
    const Box bounds = field.bounds().inflated(1e-9);
    for (const Vec3& x : mesh.vertices) {
      EXPECT_NEAR(field.distance(x), 0, 1e-12);
      EXPECT_TRUE(bounds.contains(x));
    }
  }
}

TEST(PrimitiveField, NothingIsCutOff) {
  const BodyField sphere = field_of(SphereBody{Vec3(0, 1, 0), 0.5});
  EXPECT_EQ(sphere.without_overhangs().distance({0, 2, 0}), sphere.distance({0, 2, 0}));
}

}  // namespace
}  // namespace toile
