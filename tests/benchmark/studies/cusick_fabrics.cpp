// Cusick drape coefficients of measured suitings: the real cloth, elastic sheets by the rigidity that KES reads and by
// that at small curvature, a sheet that softens and rubs, and a commercial CAD.
//   study_cusick_fabrics [edge length in mm, 5] [starts, 6]
// Needs ../shared/validation/references.json.

#include "engine/experiments/cusick_drape.h"
#include "tests/validation/silent.h"
#include "tests/validation/suitings.h"

#include <cstdio>
#include <cstdlib>

using namespace toile;
using namespace toile::test;

namespace {

double coefficient_percent(const char* what, const Suiting& suiting, const Fabric& fabric, double edge, int starts) {
  Silent monitor;
  CusickDrape test{fabric};
  test.edge_length = edge;
  test.starts = starts;
  const CusickResult result = hang(test, 0, monitor);
  const double percent = 100 * result.report.coefficient;
  std::printf("%s %-22s %5.1f  (real %.1f, CAD %.1f)  nodes %.1f  %zu vertices\n", suiting.id.c_str(), what, percent,
              suiting.real, suiting.cad, result.report.nodes, result.drape.cloth.x.size());
  for (const CusickStart& start : result.report.starts)
    std::printf("     %5.1f  %2d nodes  %.3f mJ%s%s\n", 100 * start.coefficient, start.nodes, 1e3 * start.energy,
                start.at_rest ? "" : "  not at rest",
                start.nodes < 3 || start.nodes > 8 ? "  (outside the 3 to 8 nodes of real cloth)" : "");
  std::fflush(stdout);
  return percent;
}

}  // namespace

int main(int count, char** words) {
  const double edge = count > 1 ? 1e-3 * std::atof(words[1]) : 0.005;
  const int starts = count > 2 ? std::atoi(words[2]) : 6;
  if (!(edge >= 1e-3 && edge <= 0.02) || starts < 1 || !have_references()) {
    std::fprintf(stderr, "usage: study_cusick_fabrics [edge length, 1 to 20 mm] [starts]; needs the references\n");
    return 2;
  }
  double elastic = 0, small_curvature = 0, rubbing = 0, cad = 0;
  const std::vector<Suiting> suitings = measured_suitings();
  for (const Suiting& s : suitings) {
    elastic += std::abs(coefficient_percent("elastic", s, s.elastic, edge, starts) - s.real);
    small_curvature += std::abs(
        coefficient_percent("elastic, small curv.", s, elastic_at_small_curvature(s.elastic), edge, starts) - s.real);
    rubbing += std::abs(
        coefficient_percent("softening and rubbing", s, softening_and_rubbing(s.elastic), edge, starts) - s.real);
    cad += std::abs(s.cad - s.real);
  }
  const double n = static_cast<double>(suitings.size());
  std::printf(
      "mean absolute error: elastic %.1f, elastic at small curvature %.1f, softening and rubbing %.1f, commercial "
      "CAD %.1f points\n",
      elastic / n, small_curvature / n, rubbing / n, cad / n);
  return 0;
}
