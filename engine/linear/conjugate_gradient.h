#pragma once
// Preconditioned conjugate gradients in single precision, deterministic on any number of threads.

#include "engine/linear/block_matrix.h"
#include "engine/linear/contact_matrix.h"
#include "engine/linear/rank_one_matrix.h"

namespace toile {

/// The inverse of each node's 3×3 diagonal block; a node whose block is zero is held: its unknown stays zero and its
/// equation is left out. (3-block Jacobi, the first seed's §6.3.)
class BlockJacobi {
 public:
  explicit BlockJacobi(int rows = 0) : inverse_(rows) {}
  void set(int row, const Eigen::Matrix3f& diagonal_block);
  void hold(int row) { inverse_[row].setZero(); }
  bool held(int row) const { return inverse_[row](0, 0) == 0.0f; }
  const Eigen::Matrix3f& inverse(int row) const { return inverse_[row]; }

 private:
  std::vector<Eigen::Matrix3f> inverse_;
};

struct CgOutcome {
  int iterations = 0;
  double relative_residual = 0;  ///< ‖A x − b‖ / ‖b‖ by recurrence
};

/// Solves (fixed + dynamic + Σ wide) x = b for symmetric positive definite matrices, to ‖A x − b‖ <
/// tolerance ‖b‖ or `most_iterations`. On entry x is a guess, used if its residual is below ‖b‖, else zero is; empty
/// means zero. Vectors are single precision, dot products are summed in double over fixed ranges. Stops early where
/// rounding makes a direction's curvature not positive: x is then the best so far. Keeps its work vectors between
/// calls; one call at a time.
class ConjugateGradient {
 public:
  CgOutcome solve(const BlockMatrix& fixed, ContactMatrix& dynamic, const BlockJacobi& preconditioner,
                  const NodeVector& b, double tolerance, int most_iterations, NodeVector& x,
                  std::span<RankOneMatrix* const> wide = {});

 private:
  NodeVector residual_, preconditioned_, direction_, product_;
};

}  // namespace toile
