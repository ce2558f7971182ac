// The patch test of bending: surfaces of constant curvature are in equilibrium on irregular meshes and at free edges.

#include "engine/terms/bending.h"
#include "engine/terms/curvature_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace toile;

namespace {

constexpr double kPlateEdge = 0.01;  ///< [m]
constexpr int kSide = 14;            ///< cells
const Directional kPlateBending = {9e-6, 4e-6, 7e-6};

struct Mesh {
  Cloth cloth;
  std::vector<int> rings;  ///< per vertex: from the rim
};

/// A rectangle of nearly equilateral triangles, its inner vertices moved at random by this share of an edge.
Mesh lattice(double spread, const Fabric& fabric) {
  Mesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> moved(-spread, spread);
  std::vector<Vec2> flat;
  const auto at = [](int i, int j) { return j * (kSide + 1) + i; };
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      const int ring = std::min({i, j, kSide - i, kSide - j});
      const double shift = ring == 0 && (i == 0 || i == kSide) ? 0 : 0.5 * (j % 2);
      Vec2 p(i + (i == kSide ? 0 : shift), j * std::sqrt(3.0) / 2);
      if (ring > 0) p += Vec2(moved(random), moved(random));
      flat.push_back(kPlateEdge * p);
      mesh.rings.push_back(ring);
      mesh.cloth.x.emplace_back(flat.back().x(), flat.back().y(), 0);
    }
  const auto add = [&](int a, int b, int c) {
    mesh.cloth.triangles.push_back({a, b, c});
    mesh.cloth.flat.push_back({flat[a], flat[b], flat[c]});
  };
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (j % 2 == 0)
        add(a, b, d), add(b, c, d);
      else
        add(a, b, c), add(a, c, d);
    }
  mesh.cloth.triangle_panel.assign(mesh.cloth.triangles.size(), 0);
  mesh.cloth.panels.resize(1);
  mesh.cloth.fabrics = {fabric};
  return mesh;
}

Fabric plate_fabric(const Directional& bending) {
  Fabric f;
  f.bending_stiffness = bending;
  return f;
}

/// What the flat mesh answers to small heights: the force and the stiffness against moving alone, per vertex, and the
/// energy per triangle.
struct Answer {
  std::vector<double> force, stiffness, energy;
};

Answer answer(const Cloth& cloth, const std::vector<double>& height) {
  Answer result{std::vector<double>(cloth.x.size(), 0), std::vector<double>(cloth.x.size(), 0), {}};
  for (const BendingStencil& s : bending_stencils(cloth).stencils) {
    StencilPoints<6> x;
    for (int k = 0; k < 6; ++k) x[k] = cloth.x[s.nodes[k]];
    const StencilMatrix<6> k = bending_hessian_psd(s, nullptr, x);
    double energy = 0;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double block = k(3 * i + 2, 3 * j + 2);
        result.force[s.nodes[i]] += block * height[s.nodes[j]];
        if (s.nodes[i] == s.nodes[j]) result.stiffness[s.nodes[i]] += block;
        energy += 0.5 * height[s.nodes[i]] * block * height[s.nodes[j]];
      }
    result.energy.push_back(energy);
  }
  return result;
}

std::vector<double> quadratic(const Cloth& cloth, const Vec3& curvature) {
  std::vector<double> height;
  for (const Vec3& p : cloth.x)
    height.push_back(-0.5 *
                     (curvature[0] * p.x() * p.x() + curvature[1] * p.y() * p.y() + curvature[2] * p.x() * p.y()));
  return height;
}

/// Largest share of the surface's energy around a vertex that it gains by moving alone, f²/(2 k) over ½ area κᵀ D κ.
double largest_gain(const Mesh& mesh, const Vec3& curvature, int from_ring, int to_ring) {
  const Answer a = answer(mesh.cloth, quadratic(mesh.cloth, curvature));
  const double energy =
      0.5 * kPlateEdge * kPlateEdge * std::sqrt(3.0) / 2 * curvature.dot(directional_tensor(kPlateBending) * curvature);
  double largest = 0;
  for (std::size_t v = 0; v < a.force.size(); ++v)
    if (mesh.rings[v] >= from_ring && mesh.rings[v] <= to_ring)
      largest = std::max(largest, 0.5 * a.force[v] * a.force[v] / a.stiffness[v] / energy);
  return largest;
}

}  // namespace

TEST(BendingBalance, ConstantCurvatureIsInEquilibriumOnAnIrregularMesh) {
  const Mesh mesh = lattice(0.2, plate_fabric(kPlateBending));
  for (const Vec3& curvature : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -1, 0.5)}) {
    const double gain = largest_gain(mesh, curvature, 3, kSide);
    std::printf("curvature (%g, %g, %g): a vertex gains %.2e of the energy at most\n", curvature[0], curvature[1],
                curvature[2], gain);
    EXPECT_LT(gain, 1e-3);
  }
}

TEST(BendingBalance, EnergyOfConstantCurvatureIsAPlates) {
  const Mesh mesh = lattice(0.2, plate_fabric(kPlateBending));
  for (const Vec3& curvature : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0)}) {
    const Answer a = answer(mesh.cloth, quadratic(mesh.cloth, curvature));
    const double density = 0.5 * curvature.dot(directional_tensor(kPlateBending) * curvature);
    double energy = 0, area = 0;
    for (std::size_t t = 0; t < a.energy.size(); ++t) {
      const Triangle& v = mesh.cloth.triangles[t];
      if (std::min({mesh.rings[v[0]], mesh.rings[v[1]], mesh.rings[v[2]]}) < 2) continue;
      const auto& flat = mesh.cloth.flat[t];
      const Vec2 p = flat[1] - flat[0], q = flat[2] - flat[0];
      area += 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
      energy += a.energy[t];
    }
    EXPECT_NEAR(energy / (area * density), 1, 0.005) << curvature.transpose();
  }
}

TEST(BendingBalance, FreeEdgesCarryNoForceOfBendingAlongThem) {
  // Rings 0 to 2 away from the corners: bent along the horizontal edges, with the lateral curvature that the coupling
  // of this fabric asks for where the sides are free.
  const Mesh mesh = lattice(0.2, plate_fabric(kPlateBending));
  const Vec3 curvature = directional_tensor(kPlateBending).inverse() * Vec3(1, 0, 0);
  const Answer a = answer(mesh.cloth, quadratic(mesh.cloth, curvature));
  const double energy =
      0.5 * kPlateEdge * kPlateEdge * std::sqrt(3.0) / 2 * curvature.dot(directional_tensor(kPlateBending) * curvature);
  double largest = 0;
  for (std::size_t v = 0; v < a.force.size(); ++v) {
    const int i = static_cast<int>(v) % (kSide + 1);
    if (std::min(i, kSide - i) > 3)
      largest = std::max(largest, 0.5 * a.force[v] * a.force[v] / a.stiffness[v] / energy);
  }
  std::printf("a vertex gains %.2e of the energy at most\n", largest);
  EXPECT_LT(largest, 2e-3);
}

TEST(BendingBalance, EquilateralTrianglesStayAsTheyAre) {
  const Mesh mesh = lattice(0, plate_fabric(kPlateBending));
  EXPECT_LT(largest_gain(mesh, Vec3(1, 0.3, -0.2), 6, kSide), 1e-7);  // the ragged sides' influence dies away
}

TEST(BendingBalance, LawsSeeTheCurvatureOfTheBalancedForm) {
  Fabric fabric = plate_fabric(kPlateBending);
  fabric.bending_softening = {3e-3, 2e-3, 2.5e-3};
  const BendingStencils made = bending_stencils(lattice(0.2, fabric).cloth);
  ASSERT_EQ(made.laws.size(), made.stencils.size());
  for (std::size_t t = 0; t < made.laws.size(); ++t) {
    const Mat3 k = made.stencils[t].factor.transpose() * made.stencils[t].factor;
    const BendingLaw& law = made.laws[t];
    EXPECT_LT((law.area * law.fit.transpose() * law.stiffness * law.fit - k).norm(), 1e-9 * k.norm()) << t;
  }
}
