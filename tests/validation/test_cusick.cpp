// The Cusick drape of measured suitings: a short version of tests/benchmark/studies/cusick_fabrics.cpp, on a coarse
// mesh and from one start each.

#include "engine/experiments/cusick_drape.h"
#include "tests/validation/silent.h"
#include "tests/validation/suitings.h"

#include <cstdio>

using namespace toile;
using namespace toile::test;

namespace {

CusickReport hung(const Fabric& fabric, double edge_length = 0.007) {
  Silent monitor;
  CusickDrape test{fabric};
  test.edge_length = edge_length;
  test.starts = 1;
  const CusickResult result = hang(test, 0, monitor);
  EXPECT_TRUE(result.report.starts[0].at_rest);
  return result.report;
}

using SheetOf = Fabric (*)(const Fabric& elastic);

struct MeanError {
  double ours = 0, cad = 0;  ///< [points]
};

/// Hangs each suiting, the limper first, as this sheet.
MeanError hang_all(SheetOf sheet) {
  double last = 0;
  MeanError error;
  for (const Suiting& suiting : measured_suitings()) {
    const CusickReport hanging = hung(sheet(suiting.elastic));
    const double ours = 100 * hanging.coefficient;
    std::printf("%s: reference %.1f, ours %.1f, error %+.1f, %g nodes; commercial CAD %.1f\n", suiting.id.c_str(),
                suiting.real, ours, ours - suiting.real, hanging.nodes, suiting.cad);
    EXPECT_GE(hanging.nodes, 3);  // as real cloth
    EXPECT_LE(hanging.nodes, 8);
    EXPECT_GT(ours, last) << suiting.id;
    EXPECT_NEAR(ours, suiting.real, 15) << suiting.id;
    last = ours;
    error.ours += std::abs(ours - suiting.real) / 3;
    error.cad += std::abs(suiting.cad - suiting.real) / 3;
  }
  std::printf("mean absolute error %.1f points, commercial CAD %.1f\n", error.ours, error.cad);
  return error;
}

}  // namespace

TEST(CusickReference, SuitingsAsElasticSheetsDrapeInTheRealOrder) {
  SKIP_WITHOUT_REFERENCES();
  const MeanError error = hang_all(elastic_at_small_curvature);
  EXPECT_LT(error.ours, error.cad);
}

/// 6.2 points are the commercial CAD's over all six suitings of the source (../shared/validation/README.md).
TEST(CusickReference, SuitingsThatSoftenAndRubDrapeInTheRealOrder) {
  SKIP_WITHOUT_REFERENCES();
  EXPECT_LT(hang_all(softening_and_rubbing).ours, 6.2);
}

TEST(CusickReference, ElasticSheetIsLimperThanOneThatRubs) {
  SKIP_WITHOUT_REFERENCES();
  const Suiting firm = measured_suitings().back();
  const double elastic = 100 * hung(firm.elastic).coefficient,
               rubbing = 100 * hung(softening_and_rubbing(firm.elastic)).coefficient;
  std::printf("%s: elastic by the rigidity of KES %.1f, softening and rubbing %.1f, reference %.1f\n", firm.id.c_str(),
              elastic, rubbing, firm.real);
  EXPECT_LT(elastic, rubbing);
}

TEST(Cusick, BoardKeepsItsShadow) {
  Fabric board;
  board.area_density = 0.2;
  board.stretch_stiffness = {3000, 3000, 1000};
  board.bending_stiffness = {1e-2, 1e-2, 1e-2};
  board.thickness = 3e-4;
  const CusickReport hanging = hung(board, 0.015);
  EXPECT_GT(hanging.coefficient, 0.98);
  EXPECT_LE(hanging.coefficient, 1);
  EXPECT_EQ(hanging.nodes, 0);
}
