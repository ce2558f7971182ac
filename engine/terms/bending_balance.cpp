#include "engine/terms/bending_balance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace toile {

namespace {

constexpr double kWeight = 1000;           // of forces and energies over |X|²
constexpr double kLeast = 0.3, kMost = 3;  // eigenvalues of 1 + X
constexpr double kStraight = 0.7;          // cosine; edges that turn further make a corner
constexpr double kTolerance = 1e-4;        // of conjugate gradients
constexpr int kMostIterations = 300;

using Symmetric = std::vector<Mat3>;  ///< one a stencil

double dot(const Symmetric& a, const Symmetric& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].cwiseProduct(b[i]).sum();
  return sum;
}

/// What a vertex asks for: matrices that turn its force and energy into the gradient of the weighted squares.
struct Demand {
  Mat3 force = Mat3::Zero();  ///< w s² V Vᵀ
  Mat3 basis = Mat3::Zero();  ///< V Vᵀ, V the curvatures that count, as columns
  double energy = 0;          ///< w over the squared area around it
};

/// Directions of free edges, as long as they are nearly one.
struct FreeEdge {
  Vec2 direction = Vec2::Zero();
  bool any = false, corner = false;

  void add(Vec2 along) {
    if (any && std::abs(along.dot(direction.normalized())) < kStraight) corner = true;
    if (along.dot(direction) < 0) along = -along;
    direction += along;
    any = true;
  }
};

class Balance {
 public:
  Balance(std::span<const FlatBending> stencils, std::size_t vertices)
      : stencils_(stencils), curved_(stencils.size()), raised_(stencils.size()), demand_(vertices) {
    for (std::size_t i = 0; i < stencils.size(); ++i) {
      curved_[i] = stencils[i].factor * stencils[i].rows;
      raised_[i] = stencils[i].factor * stencils[i].angles;
      if (curved_[i].allFinite() && raised_[i].allFinite()) continue;
      curved_[i].setZero();
      raised_[i].setZero();
    }
    find_demands(vertices);
  }

  Symmetric solve() const {
    const std::size_t n = stencils_.size();
    std::vector<Vec3> force(demand_.size(), Vec3::Zero());
    std::vector<Mat3> energy(demand_.size(), Mat3::Zero());
    add_forces_and_energies(Symmetric(n, Mat3::Identity()), force, energy);
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) energy[stencils_[i].nodes[k]] -= stencils_[i].area * stencils_[i].stiffness;
    Symmetric residual(n, Mat3::Zero());
    add_transposed(force, energy, residual);
    for (Mat3& m : residual) m = -m;

    Symmetric x(n, Mat3::Zero()), direction = residual;
    double size = dot(residual, residual);
    const double enough = kTolerance * kTolerance * size;
    for (int k = 0; k < kMostIterations && size > enough; ++k) {
      const Symmetric image = apply(direction);
      const double step = size / dot(direction, image);
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += step * direction[i];
        residual[i] -= step * image[i];
      }
      const double next = dot(residual, residual);
      for (std::size_t i = 0; i < n; ++i) direction[i] = residual[i] + next / size * direction[i];
      size = next;
    }
    return x;
  }

 private:
  void find_demands(std::size_t vertices) {
    std::vector<FreeEdge> free(vertices);
    std::vector<char> held(vertices, 0), counts(vertices, 1);
    std::vector<int> panel(vertices, -1), corners(vertices, 0);
    std::vector<double> area(vertices, 0), stiffness(vertices, 0);
    std::vector<const Mat3*> fabric(vertices, nullptr);
    for (std::size_t i = 0; i < stencils_.size(); ++i) {
      const FlatBending& s = stencils_[i];
      const int missing = 3 - s.hinge[0] - s.hinge[1] - s.hinge[2];
      for (int k = 0; k < 6; ++k) {
        if (k >= 3 && !s.hinge[k - 3]) continue;
        const int v = s.nodes[k];
        if (panel[v] >= 0 && panel[v] != s.panel) counts[v] = 0;
        panel[v] = s.panel;
        fabric[v] = &s.stiffness;
        if (!s.plain || missing > 1 || curved_[i].isZero(0)) counts[v] = 0;
        if (k >= 3 && s.clamped[k - 3]) held[v] = 1;
        if (k < 3 && (s.clamped[(k + 1) % 3] || s.clamped[(k + 2) % 3])) held[v] = 1;
        for (int c = 0; c < 3; ++c)
          if (!s.hinge[c]) free[v].add(s.along[c]);
        stiffness[v] += raised_[i].col(k).squaredNorm();
        if (k >= 3) continue;
        area[v] += s.area;
        ++corners[v];
      }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
      if (!counts[v] || corners[v] == 0 || free[v].corner || !(stiffness[v] > 0)) continue;
      Demand& d = demand_[v];
      if (free[v].any) {
        const Vec2 t = free[v].direction.normalized();
        const Vec3 curvature = fabric[v]->llt().solve(Vec3(t.x() * t.x(), t.y() * t.y(), t.x() * t.y()));
        d.basis = curvature * curvature.transpose() / curvature.dot(*fabric[v] * curvature);
      } else {
        d.basis = fabric[v]->inverse();
      }
      const double edge_squared = area[v] / corners[v] * 4 / std::sqrt(3.0);
      if (!held[v]) d.force = kWeight / (stiffness[v] * edge_squared) * d.basis;
      d.energy = kWeight / (area[v] * area[v]);
    }
  }

  /// Per vertex: forces Σ (F θ′)ᵀ X F B, and the energies' Σ Bᵀ Fᵀ X F B.
  void add_forces_and_energies(const Symmetric& x, std::vector<Vec3>& force, std::vector<Mat3>& energy) const {
    for (std::size_t i = 0; i < stencils_.size(); ++i) {
      const FlatBending& s = stencils_[i];
      const Mat3 moment = x[i] * curved_[i], stored = curved_[i].transpose() * moment;
      const Eigen::Matrix<double, 3, 6> f = moment.transpose() * raised_[i];
      for (int k = 0; k < 6; ++k) {
        if (k >= 3 && !s.hinge[k - 3]) continue;
        force[s.nodes[k]] += f.col(k);
        if (k < 3) energy[s.nodes[k]] += stored;
      }
    }
  }

  void add_transposed(std::vector<Vec3>& force, std::vector<Mat3>& energy, Symmetric& x) const {
    for (std::size_t v = 0; v < demand_.size(); ++v) {
      const Demand& d = demand_[v];
      force[v] = d.force * force[v];
      energy[v] = d.energy * (d.basis * energy[v] * d.basis);
    }
    for (std::size_t i = 0; i < stencils_.size(); ++i) {
      const FlatBending& s = stencils_[i];
      Mat3 outer = Mat3::Zero(), sum = Mat3::Zero();
      for (int k = 0; k < 6; ++k) {
        if (k >= 3 && !s.hinge[k - 3]) continue;
        outer += raised_[i].col(k) * force[s.nodes[k]].transpose();
        if (k < 3) sum += energy[s.nodes[k]];
      }
      const Mat3 pressed = outer * curved_[i].transpose();
      x[i] += 0.5 * (pressed + pressed.transpose()) + curved_[i] * sum * curved_[i].transpose();
    }
  }

  Symmetric apply(const Symmetric& x) const {
    std::vector<Vec3> force(demand_.size(), Vec3::Zero());
    std::vector<Mat3> energy(demand_.size(), Mat3::Zero());
    add_forces_and_energies(x, force, energy);
    Symmetric result = x;
    add_transposed(force, energy, result);
    return result;
  }

  std::span<const FlatBending> stencils_;
  std::vector<Mat3> curved_;                         ///< F B
  std::vector<Eigen::Matrix<double, 3, 6>> raised_;  ///< F · angles
  std::vector<Demand> demand_;                       ///< per vertex
};

}  // namespace

std::vector<Mat3> balanced(std::span<const FlatBending> stencils, std::size_t vertices) {
  std::vector<Mat3> result = Balance(stencils, vertices).solve();
  for (Mat3& m : result) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(m);
    const double low = eigen.eigenvalues()[0], high = eigen.eigenvalues()[2];
    const double share = std::min({1.0, (1 - kLeast) / std::max(-low, 1e-9), (kMost - 1) / std::max(high, 1e-9)});
    const Vec3 root = (Vec3::Ones() + share * eigen.eigenvalues()).cwiseSqrt();
    m = eigen.eigenvectors() * root.asDiagonal() * eigen.eigenvectors().transpose();
  }
  return result;
}

}  // namespace toile
