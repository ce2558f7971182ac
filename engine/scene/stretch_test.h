#pragma once
// From a uniaxial stretch test, as a laboratory measures it, to the stress curves of a fabric.

#include "engine/scene/fabric.h"

#include <string>
#include <vector>

namespace toile {

/// One reading: elongation over rest length, and force per rest width [N/m].
struct ForceStrain {
  double strain = 0, force = 0;
};

/// Readings of strips pulled along warp, weft and 45° with free sides; (0, 0) goes without saying. A direction without
/// readings stays linear.
struct StretchTest {
  std::vector<ForceStrain> warp, weft, bias;
};

/// Gives the fabric the stress curves with which a strip that is free to narrow answers with the measured forces. With
/// λ = 1 + strain, E = ½ (λ² − 1), P the force and ν the Poisson ratio, whose coupling is C_poisson = ν √(C_warp
/// C_weft) of the tangents at rest:
///   along warp   S_warp(E) = P/λ + (C_poisson²/C_weft) E, since the weft's strain is −C_poisson/C_weft · E, in
///                compression, where the weft's stress is linear; the tangent at rest is that of P/λ over 1 − ν²; and
///                likewise along weft;
///   along bias   warp and weft carry P/2λ each, which gives their strains, and P/2λ is the shear stress at the shear
///                strain E − ½ (E_weft + E_warp).
/// Sets stretch_stiffness of measured directions and poisson_stiffness to match. Between readings as
/// monotone_stress_curve(). Throws InputError at `pointer`/warp/3 or the like: curve_not_rising (strain, force, and
/// force over stretch must rise strictly from one reading to the next), curve_too_stiff (the bias is stiffer than warp
/// and weft allow), curve_too_soft (a tangent falls so low that the coupling outweighs it), poisson_too_large (the
/// sides would close in by so much that the triangle resists collapse).
void apply_stretch_test(const StretchTest& test, double poisson_ratio, const std::string& pointer, Fabric& fabric);

}  // namespace toile
