#include "engine/quality/mesh_bending.h"

#include "engine/geometry/flat_triangle.h"
#include "engine/terms/bending.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

namespace toile {

namespace {

constexpr std::size_t kMostTriangles = 1500;
constexpr int kFewestInnerVertices = 20;
constexpr double kWorthAWarning = 0.02;

/// The middle of a panel, flat, with a fabric of D = 1 N·m.
Cloth middle_of(const Cloth& cloth, int panel) {
  std::vector<std::pair<double, int>> by_distance;
  Vec2 middle = Vec2::Zero();
  for (std::size_t t = 0; t < cloth.triangles.size(); ++t)
    if (cloth.triangle_panel[t] == panel) by_distance.emplace_back(0, static_cast<int>(t));
  const auto center = [&](int t) { return Vec2((cloth.flat[t][0] + cloth.flat[t][1] + cloth.flat[t][2]) / 3); };
  for (const auto& [distance, t] : by_distance) middle += center(t) / static_cast<double>(by_distance.size());
  for (auto& [distance, t] : by_distance) distance = (center(t) - middle).squaredNorm();
  std::sort(by_distance.begin(), by_distance.end());
  by_distance.resize(std::min(by_distance.size(), kMostTriangles));

  Cloth part;
  std::map<std::tuple<int, double, double>, int> number;  // a vertex may lie on the panel twice, apart
  for (const auto& [distance, t] : by_distance) {
    Triangle corners;
    std::array<Vec2, 3> flat;
    for (int c = 0; c < 3; ++c) {
      flat[c] = cloth.flat[t][c] - middle;
      const auto [at, fresh] =
          number.try_emplace({cloth.triangles[t][c], flat[c].x(), flat[c].y()}, static_cast<int>(part.x.size()));
      if (fresh) part.x.emplace_back(flat[c].x(), flat[c].y(), 0);
      corners[c] = at->second;
    }
    part.triangles.push_back(corners);
    part.flat.push_back(flat);
    part.triangle_panel.push_back(0);
  }
  part.panels.resize(1);
  part.fabrics.resize(1);
  part.fabrics[0].bending_stiffness = {1, 1, 1};
  return part;
}

bool inside(const BendingStencil& s) { return s.hinge[0] && s.hinge[1] && s.hinge[2]; }

/// Vertices that all triangles around have all their hinges.
std::vector<char> inner_vertices(const Cloth& part, const std::vector<BendingStencil>& stencils) {
  std::vector<int> around(part.x.size(), 0);
  for (const Triangle& t : part.triangles)
    for (int v : t) ++around[v];
  for (const BendingStencil& s : stencils)
    if (inside(s))
      for (int c = 0; c < 3; ++c) --around[s.nodes[c]];
  std::vector<char> inner(part.x.size());
  for (std::size_t v = 0; v < inner.size(); ++v) inner[v] = around[v] == 0;
  return inner;
}

}  // namespace

MeshBending measure_mesh_bending(const Cloth& cloth, int panel) {
  const Cloth part = middle_of(cloth, panel);
  const std::vector<BendingStencil> stencils = bending_stencils(part).stencils;
  const std::vector<char> inner = inner_vertices(part, stencils);
  std::vector<int> unknown(part.x.size(), -1);
  int unknowns = 0;
  for (std::size_t v = 0; v < inner.size(); ++v)
    if (inner[v]) unknown[v] = unknowns++;
  if (unknowns < kFewestInnerVertices) return {};

  // Heights of the three surfaces of unit curvature, the energies between them, and their forces on the inner vertices.
  Eigen::Matrix<double, Eigen::Dynamic, 3> height(part.x.size(), 3), force(unknowns, 3);
  for (std::size_t v = 0; v < part.x.size(); ++v) {
    const double x = part.x[v].x(), y = part.x[v].y();
    height.row(static_cast<long>(v)) << 0.5 * x * x, 0.5 * y * y, 0.5 * x * y;
  }
  force.setZero();
  Mat3 energy = Mat3::Zero();
  double area = 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (const BendingStencil& s : stencils) {
    if (!inside(s) || std::none_of(s.nodes.begin(), s.nodes.end(), [&](int v) { return inner[v]; })) continue;
    StencilPoints<6> x;
    for (int i = 0; i < 6; ++i) x[i] = part.x[s.nodes[i]];
    const StencilMatrix<6> hessian = bending_hessian_psd(s, nullptr, x);
    area += flat_area({Vec2(x[0].head<2>()), Vec2(x[1].head<2>()), Vec2(x[2].head<2>())});
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double k = hessian(3 * i + 2, 3 * j + 2);
        energy += k * height.row(s.nodes[i]).transpose() * height.row(s.nodes[j]);
        if (!inner[s.nodes[i]]) continue;
        force.row(unknown[s.nodes[i]]) += k * height.row(s.nodes[j]);
        if (inner[s.nodes[j]]) entries.emplace_back(unknown[s.nodes[i]], unknown[s.nodes[j]], k);
      }
  }
  Eigen::SparseMatrix<double> stiffness(unknowns, unknowns);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(stiffness);
  solver.setTolerance(1e-4);
  const Mat3 left = (energy - force.transpose() * solver.solve(force)) / area;

  MeshBending found{INFINITY, 0};
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
    const Vec3 cylinder(c * c, s * s, 2 * c * s);
    const double d = cylinder.dot(left * cylinder);
    found = {std::min(found.least, d), std::max(found.largest, d)};
  }
  return found;
}

void warn_of_mesh_bending(Cloth& cloth, const std::vector<char>& garments) {
  for (std::size_t p = 0; p < cloth.panels.size(); ++p) {
    if (!garments.at(static_cast<std::size_t>(cloth.panels[p].garment))) continue;
    const MeshBending found = measure_mesh_bending(cloth, static_cast<int>(p));
    if (found.least > 1 - kWorthAWarning && found.largest < 1 + kWorthAWarning) continue;
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(),
                  "mesh_bending: panel '%.80s' bends with %.0f to %.0f %% of its fabric's stiffness, depending on the "
                  "direction, because of how its triangles lie; near-equilateral ones bend right",
                  cloth.panels[p].name.c_str(), 100 * found.least, 100 * found.largest);
    cloth.warnings.emplace_back(text.data());
  }
}

}  // namespace toile
