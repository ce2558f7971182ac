// The first seed's Table 1 on this engine: the twisted sheet (tests/validation/twisted_sheet.h) for each Newton
// tolerance and splitting factor, as time and mean vertex distance to the run with tolerance 1e-7 and factor 0.5.
//   study_twisted_sheet <edge length in mm> [soft|stiff] [omega ...]
// 10.3 mm gives the paper's coarse mesh (30,000 degrees of freedom), 3.3 mm its fine one (300,000).

#include "tests/validation/twisted_sheet.h"
#include "engine/quality/distance_between.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace toile;
using namespace toile::test;

namespace {

struct Outcome {
  Positions x;
  double seconds = 0, simulated = 0;
  std::size_t vertices = 0, crossings = 0, contacts = 0;
  long splits = 0;
  bool finite = false;
};

Outcome run(const Fabric& fabric, double edge_length, double newton_tolerance, double splitting_factor) {
  TwistedSheet sheet(fabric, edge_length);
  sheet.scene.options.newton_tolerance = newton_tolerance;
  sheet.scene.options.newton_momentum_fraction = 0;  // as the paper: the absolute tolerance alone
  sheet.scene.options.splitting_factor = splitting_factor;
  const auto begun = std::chrono::steady_clock::now();
  const Simulation result = sheet.run();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return {sheet.cloth.x,
          seconds,
          result.time,
          sheet.cloth.x.size(),
          self_intersections(sheet.cloth.x, sheet.cloth.triangles).size(),
          result.cloth_contacts,
          result.splits,
          all_finite(sheet.cloth.x)};
}

}  // namespace

int main(int count, char** words) {
  const double edge_length = count > 1 ? 1e-3 * std::atof(words[1]) : 0;
  if (!(edge_length >= 1e-3 && edge_length <= 0.1)) {
    std::fprintf(stderr, "usage: study_twisted_sheet <edge length, 1 to 100 mm> [soft|stiff] [omega ...]\n");
    return 2;
  }
  const Fabric fabric = count > 2 && std::string(words[2]) == "stiff" ? stiff_woven() : soft_knit();
  std::vector<double> factors;
  for (int k = 3; k < count; ++k) factors.push_back(std::atof(words[k]));
  if (factors.empty()) factors = {0.25, 0.5, 0.75};

  const Outcome reference = run(fabric, edge_length, 1e-7, 0.5);
  std::printf("%zu vertices; reference (1e-7, 0.5): %.1f s, %zu crossings\n", reference.vertices, reference.seconds,
              reference.crossings);
  std::printf("%-8s %-6s %10s %8s %10s %10s %10s %10s %s\n", "tau_n", "omega", "time s", "splits", "mean mm", "max mm",
              "contacts", "crossings", "state");
  for (double tolerance : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1})
    for (double factor : factors) {
      const Outcome ours = run(fabric, edge_length, tolerance, factor);
      const DrapeDistance distance = vertex_distance(ours.x, reference.x);
      std::printf("%-8.0e %-6.2f %10.1f %8ld %10.2f %10.2f %10zu %10zu %s\n", tolerance, factor, ours.seconds,
                  ours.splits, 1e3 * distance.mean, 1e3 * distance.max, ours.contacts, ours.crossings,
                  !ours.finite            ? "not finite"
                  : ours.simulated < 2.99 ? "stopped early"
                                          : "ended");
      std::fflush(stdout);
    }
  return 0;
}
