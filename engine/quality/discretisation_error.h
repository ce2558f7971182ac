#pragma once
// How far a drape is, on the average, from the one that the same scene would give on an ever finer mesh.

#include "engine/contact/contact.h"
#include "engine/mesh/cloth.h"

#include <span>

namespace toile {

/// Estimate of the mean distance between the surfaces [m], from one drape alone: the sum of
///   shape    c (1/A) Σ_t A_t h_t² ‖S_t‖ over triangles of flat area A_t, h_t the edge of an equilateral triangle as
///   large
///            and S_t = Σ_e ½ θ_e l_e n_e n_eᵀ / A_t the curvature tensor [Cohen-Steiner and Morvan 2003] from the
///            hinge angles θ_e of its edges, of flat length l_e and normal n_e (exact for a bent equilateral lattice).
///            A piecewise linear surface is off a smooth one by h² |κ| / 8 at most, and hinges bend with an error of
///            the same order, which shows as displaced folds;
///   offset   the share of the area that presses on the body times what contact keeps it too far off, the distance at
///            which repulsion begins less half the fabric's thickness: it shrinks with the edge length until it is
///            nothing.
/// c is calibrated, once, on the sphere of tests/validation/refinement_scenes.h (the geometric mean over its edge
/// lengths); table edge, cone and body then judge it: `refinement_study` prints the ratios. What no such estimate can
/// see is in neither: another number of folds, friction that stuck elsewhere, a drape that is not at rest. Folds
/// pressed in count as if they were bent. `body_contacts` are those with the body, at the cloth's positions.
double discretisation_error(const Cloth& cloth, std::span<const Contact> body_contacts);

inline constexpr double kShapeErrorFactor = 0.8;  ///< c

}  // namespace toile
