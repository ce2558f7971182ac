#pragma once
// What all terms share: fixed-size vectors over the nodes of a stencil and the answer that a term gives to the solver.

#include "engine/types.h"

namespace toile {

/// Gradient over N nodes, node-major.
template <int N>
using StencilVector = Eigen::Matrix<double, 3 * N, 1>;
/// Hessian over N nodes.
template <int N>
using StencilMatrix = Eigen::Matrix<double, 3 * N, 3 * N>;
/// Positions or velocities of a stencil's nodes.
template <int N>
using StencilPoints = std::array<Vec3, N>;

/// A 3×3 block of the system matrix. Single precision: derivatives are computed in double and rounded when they enter
/// the matrix (the mixed scheme of the first seed's §6.2); forces stay double.
using MatrixBlock = Eigen::Matrix3f;

/// How much of each kind of derivative a block of the system matrix takes:
///   block = stiffness · ∂²E/∂x² + dissipation · ∂²R/∂v²,
/// backward Euler: stiffness = h², dissipation = h (times the relaxation's factor on the fabric's stiffness, which also
/// scales the forces).
struct SystemWeights {
  double stiffness;    ///< [s²]
  double dissipation;  ///< [s]
  double fabric = 1;   ///< factor on fabric stiffness and its damping
};

/// Index of the block (i, j), i ≤ j, in the upper triangle of N × N blocks stored row by row.
template <int N>
constexpr int upper_block(int i, int j) {
  return i * N - i * (i - 1) / 2 + (j - i);
}

/// Force on each node [N] and the upper triangle of the positive semi-definite system blocks [kg].
template <int N>
struct StencilResponse {
  std::array<Vec3, N> force;
  std::array<MatrixBlock, N*(N + 1) / 2> block;
};

}  // namespace toile
