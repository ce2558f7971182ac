#pragma once
// The suitings of references.json (fabrics_measured) whose real drape coefficient is known, as sheets: elastic by the
// measured bending rigidity, elastic by that at small curvature, and with what is known of the bending of such cloths.

#include "engine/scene/fabric.h"
#include "tests/validation/references.h"

#include <cmath>
#include <string>
#include <vector>

namespace toile::test {

struct Suiting {
  std::string id;
  double real = 0, cad = 0;  ///< drape coefficients of the cloth and of a commercial CAD [%]
  Fabric elastic;
};

/// Bending rigidity in warp and weft, weight, thickness and shear as measured. Not measured: the bias bends as the mean
/// of warp and weft, and stretch, which the source gives in a CAD's units, is that of a firm weave.
inline std::vector<Suiting> measured_suitings() {
  std::vector<Suiting> list;
  for (const int row : {0, 2, 5}) {
    const std::string at = std::string("/fabrics_measured/rows/").append(std::to_string(row));
    const double warp = 1e-6 * reference(at + "/B_warp_weft_uNm/0"), weft = 1e-6 * reference(at + "/B_warp_weft_uNm/1");
    Suiting s;
    s.id = std::string("M").append(std::to_string(row + 1));
    s.real = reference(at + "/DC_real_pct");
    s.cad = reference(at + "/DC_CLO3D_pct");
    s.elastic.name = s.id;
    s.elastic.area_density = 1e-3 * reference(at + "/g_m2");
    s.elastic.thickness = 1e-3 * reference(at + "/thickness_mm");
    s.elastic.stretch_stiffness = {3500, 2500, reference(at + "/shear_N_m")};
    s.elastic.poisson_stiffness = 0.2 * std::sqrt(3500.0 * 2500.0);
    s.elastic.bending_stiffness = {warp, weft, 0.5 * (warp + weft)};
    s.elastic.friction_cloth = 0.35;
    s.elastic.friction_body = 0.3;
    list.push_back(s);
  }
  return list;
}

/// Bending rigidity by KES-FB2 is the slope of the moment between curvatures of 0.5 and 1.5 per cm.
inline constexpr double kKesCurvature = 100;  ///< middle of those [1/m]
/// 2HB over B, about 0.46 per cm: typical of men's suitings by KES (after Kawabata, The Standardization and Analysis of
/// Hand Evaluation, 1980, whose print was not at hand to check it). It was not measured on these cloths.
inline constexpr double kHysteresisOverRigidity = 45.8;  ///< [1/m]

/// −K2/K1 of the moment K1 κ + K2 κ²: the median of the 618 fabrics, direction by direction [m].
inline Directional median_softening() {
  const auto median = [](const char* direction) {
    return -1e-3 * reference(std::string("/fabrics_618/K2_over_K1_mm/").append(direction).append("/2"));
  };
  return {median("warp"), median("weft"), median("bias")};
}

/// The elastic sheet of the rigidity that the cloth has where a drape bends it: KES reads B at the curvature above, and
/// half of a hanging specimen is bent by less than 45/m, three quarters by less than 75/m. K1 is such that the moment
/// has the measured slope where KES reads it.
inline Fabric elastic_at_small_curvature(const Fabric& elastic) {
  Fabric f = elastic;
  const Directional softening = median_softening();
  for (double Directional::*along : {&Directional::warp, &Directional::weft, &Directional::bias})
    f.bending_stiffness.*along /= 1 - 2 * softening.*along * kKesCurvature;
  return f;
}

/// The same cloth as it softens from there, and rubs by the ratio above. Nothing is fitted to a drape.
inline Fabric softening_and_rubbing(const Fabric& elastic) {
  Fabric f = elastic_at_small_curvature(elastic);
  f.bending_softening = median_softening();
  for (double Directional::*along : {&Directional::warp, &Directional::weft, &Directional::bias})
    f.bending_hysteresis.*along = kHysteresisOverRigidity * elastic.bending_stiffness.*along;
  return f;
}

}  // namespace toile::test
