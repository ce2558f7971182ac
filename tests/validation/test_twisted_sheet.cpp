// The first seed's twisted sheet, coarser than there; tests/benchmark/studies has the whole table. The paper's Table 1
// gives mean vertex distances to its tightest run of 2 to 6 mm (soft) and 0.3 to 0.8 mm (stiff) on its coarse mesh, 4
// to 12 mm (soft) and 1 to 6 mm (stiff) on the fine one.

#include "engine/quality/distance_between.h"
#include "tests/validation/twisted_sheet.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

constexpr double kCoarse = 0.06, kFine = 0.05;  // edges [m]
constexpr double kStep = 2e-3;                  // [s]
constexpr double kTableOneLeast = 0.2e-3;       // mean distances to a run of τ_n = 1e-7 [m]
constexpr double kTableOneMost = 12.23e-3;

Simulation run_well(TwistedSheet& sheet) {
  const Simulation result = sheet.run();
  EXPECT_GT(result.time, 2.999);
  EXPECT_TRUE(all_finite(sheet.cloth.x));
  EXPECT_EQ(self_intersections(sheet.cloth.x, sheet.cloth.triangles).size(), 0u);
  EXPECT_GT(result.cloth_contacts, 50u) << "its folds touch";
  return result;
}

void ends_well_whatever_the_tolerance(const Fabric& fabric, const char* kind) {
  TwistedSheet tight(fabric, kCoarse), usual(fabric, kCoarse), fine(fabric, kFine);
  for (TwistedSheet* sheet : {&tight, &usual, &fine}) sheet->scene.options.max_time_step = kStep;
  for (TwistedSheet* sheet : {&tight, &usual}) sheet->scene.options.newton_momentum_fraction = 0;  // as the paper
  tight.scene.options.newton_tolerance = 1e-7;
  const Simulation most = run_well(tight), least = run_well(usual);
  EXPECT_GT(most.newton_iterations, least.newton_iterations) << "the tolerance does something";
  const DrapeDistance distance = vertex_distance(usual.cloth.x, tight.cloth.x);
  std::cout << kind
            << ": mean distance between Newton tolerances 1e-3 and 1e-7: reference (Table 1) 0.2 to 12.2 mm, ours "
            << 1e3 * distance.mean << " mm, farthest " << 1e3 * distance.max << " mm; " << least.cloth_contacts
            << " contacts of the cloth with itself\n";
  EXPECT_GT(distance.mean, 0.5 * kTableOneLeast);
  EXPECT_LT(distance.mean, 2 * kTableOneMost);
  run_well(fine);
}

}  // namespace

// At a woven's usual 5000 N/m the tight run alone takes minutes; the study does it.
TEST(TwistedSheetReference, Stiff) { ends_well_whatever_the_tolerance(stiff_woven(1000), "stiff"); }
TEST(TwistedSheetReference, Soft) { ends_well_whatever_the_tolerance(soft_knit(), "soft"); }
