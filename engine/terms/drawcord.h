#pragma once
// A cord that runs through a channel along edges of the cloth and slides in it without friction.

#include "engine/terms/stencil.h"

#include <vector>

namespace toile {

/// One energy over all the cord's segments, l their total length:
///   E = ½ k L ε²,  ε = max(0, l/L − 1);  tension T = k ε [N], one number along the whole cord: what slides freely
/// shares its force, and where the cloth gives way the cord gathers it. Nothing while slack.
/// Dissipation as in terms/elastic.h with the strain of the whole: R = ½ β k L w ε̇².
/// With d the segments' directions and g = ∂l/∂x, the Hessian is  (k/L) g gᵀ + Σ T/lₛ (I − d dᵀ): one vector over all
/// nodes, kept factored (linear/rank_one_matrix.h), and blocks within segments. It is exact: a lagged tension would be
/// an explicit spring of stiffness k/L and unstable at h² k/L > m. Positive semi-definite everywhere.
struct DrawcordStencil {
  std::vector<std::array<int, 2>> segments;  ///< the edges, in any order; a closed cord counts its last one, too
  double rest_length;                        ///< L [m], positive
  double stiffness;                          ///< k [N] per strain
  double damping;                            ///< β [s]
};

/// What holds for the whole cord at a state.
struct DrawcordPull {
  double strain = 0;       ///< ε; 0: slack
  double strain_rate = 0;  ///< ε̇ [1/s]
  double tension = 0;      ///< elastic and dissipative T [N]
  double rate_factor = 0;  ///< β k w/L: ∂²R/∂v² = rate_factor · g gᵀ [N·s/m]
};
/// v: null for a cord at rest.
DrawcordPull drawcord_pull(const DrawcordStencil& c, const Positions& x, const Positions* v);

double drawcord_energy(const DrawcordStencil& c, const Positions& x);  ///< [J]

/// Unit vector along a segment; zero for one shorter than a micrometre, which has no direction to speak of.
Vec3 segment_direction(const std::array<int, 2>& segment, const Positions& x);
/// ∂²l/∂x² of one segment [1/m]: the block between a node and itself; minus it between the two.
Mat3 segment_curvature(const std::array<int, 2>& segment, const Positions& x);

}  // namespace toile
