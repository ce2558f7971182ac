#pragma once
// Where a panel's inner points start: hexagonal rows inside the outline, away from it by a clear band.

#include "engine/types.h"

#include <vector>

namespace toile {

/// Knows an outline (simple polygon) well enough to place seeds and to tell how near to it a point is.
class SeedLattice {
 public:
  SeedLattice(const std::vector<Vec2>& outline, double edge_length);

  /// Points of a hexagonal lattice, rows along +x from the outline's lowest point, spacing fitted to its bounding box
  /// (so that a straight hem and its parallel rows are equilateral), at least 0.55 · edge_length from the outline.
  std::vector<Vec2> seeds() const;

  /// Inside the bounding box and no nearer to the outline than `distance`, which is at most edge_length.
  bool clear(const Vec2& point, double distance) const;

 private:
  std::size_t cell(double x, double y) const;

  const std::vector<Vec2>& outline_;
  double h_;
  Vec2 low_, high_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<int>> segments_;  // per cell of size h_, those whose box, grown by h_, meets it
};

}  // namespace toile
