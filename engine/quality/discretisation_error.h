#pragma once
// How far a drape is, on the average, from the one that the same scene would give on an ever finer mesh.

#include "engine/contact/contact.h"
#include "engine/mesh/cloth.h"

#include <span>

namespace toile {

/// Estimate of the mean distance between the surfaces [m], from one drape alone: the sum of
///   chord    (1/A) Σ_t A_t h_t² ‖S_t‖ / 16 over triangles of flat area A_t, h_t the edge of an equilateral triangle
///            as large and S_t = Σ_e ½ θ_e l_e n_e n_eᵀ / A_t the curvature tensor [Cohen-Steiner and Morvan 2003]
///            from the hinge angles θ_e of its edges, of flat length l_e and normal n_e (exact for a bent equilateral
///            lattice): the mean distance of a triangle from the cylinder or ball through its corners;
///   fold     c (1/A) Σ_t A_t h_t max(h_t, ℓ) √|det S_t|, ℓ = (D/(ρ g))^⅓ the fabric's bending length. Cloth that
///            hardly stretches bends in one direction at a time, but for the tips of its cones: curvature in two is
///            what a mesh has not resolved of them (not counted along free edges, where hinges are missing). The
///            nearest folds are off as far as a tip is, which is of first order;
///   offset   the share of the area that presses on the body times what contact keeps it too far off, the distance
///            at which repulsion begins less half the fabric's thickness: it shrinks with the edge length until it
///            is nothing.
/// c is calibrated, once, on the sphere of tests/validation/refinement_scenes.h (the geometric mean over its edge
/// lengths); table edge, cone and body then judge it: `refinement_study` prints the ratios. What no such estimate can
/// see is in none: another number of folds, friction that stuck elsewhere, a drape that is not at rest. Folds pressed
/// in count as if they were bent. `body_contacts` are those with the body, at the cloth's positions.
double discretisation_error(const Cloth& cloth, std::span<const Contact> body_contacts);

inline constexpr double kFoldErrorFactor = 1.6;  ///< c

}  // namespace toile
