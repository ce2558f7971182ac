// How drapes settle as their meshes become finer, and whether the report's estimate of the discretisation error says
// so.
//
//   refinement_study [scene] [--finest MM] [--meshes FOLDER]
//
// Drapes the scenes of tests/validation/refinement_scenes.h (all, or the one named) at 20, 14, 10, 7 and 5 mm, or down
// to the length given, and prints for each edge length h: the mean distance d to the finest drape; the order
// log(d/d')/log(h/h') from the length before; the report's estimate e of the distance to a mesh of no edge length; e/d;
// and (e − e')/d, with e' the estimate of the finest, which is no exact drape itself. Takes minutes. With --meshes, the
// drapes are kept as OBJ files.

#include "engine/drape.h"
#include "engine/mesh/build_cloth.h"
#include "engine/mesh/obj.h"
#include "engine/quality/distance_between.h"
#include "tests/validation/refinement_scenes.h"

#include <cstdio>
#include <cstring>
#include <fstream>

namespace {

using namespace toile;
using namespace toile::test;

constexpr std::array<double, 5> kEdgeLengths{0.020, 0.014, 0.010, 0.007, 0.005};  // [m]

/// Says on a terminal how far a drape is.
struct Ticker : Monitor {
  bool report(const Progress& progress) override {
    if (++count % 200 == 0)
      std::fprintf(stderr, "\r%3.0f %%  %.2f s", 100 * progress.fraction_done, progress.simulated_time_s);
    return true;
  }
  long count = 0;
};

std::vector<Drape> drapes_of(const RefinementScene& study, double finest, const std::string& folder) {
  std::vector<Drape> drapes;
  for (const double h : kEdgeLengths) {
    if (h < finest - 1e-9) break;
    Ticker ticker;
    const Drape& result = drapes.emplace_back(drape(study.at(h), ticker));
    const Report& r = result.report;
    std::printf("%-10s %4.0f mm  %7ld vertices  %7.1f s  residual %.3f  penetration %.2f mm  %s\n", study.name.c_str(),
                1e3 * h, r.vertices, r.time.total, r.residual_rms, 1e3 * r.penetration_max, r.status.c_str());
    std::fflush(stdout);
    if (folder.empty()) continue;
    std::ofstream(folder + "/" + study.name + "-" + std::to_string(std::lround(1e3 * h)) + ".obj")
        << write_obj(surface_mesh(result.cloth));
  }
  return drapes;
}

void print_distances(const RefinementScene& study, const std::vector<Drape>& drapes) {
  const Drape& finest = drapes.back();
  double before = 0;
  for (std::size_t i = 0; i < drapes.size(); ++i) {
    const double estimate = drapes[i].report.discretisation_error;
    std::printf("%-10s %4.0f mm  estimate %6.3f mm", study.name.c_str(), 1e3 * kEdgeLengths[i], 1e3 * estimate);
    if (i + 1 < drapes.size()) {
      const double distance =
          surface_distance(drapes[i].cloth.x, drapes[i].cloth.triangles, finest.cloth.x, finest.cloth.triangles).mean;
      const double order = i > 0 ? std::log(before / distance) / std::log(kEdgeLengths[i - 1] / kEdgeLengths[i]) : 0;
      std::printf("  to the finest %6.3f mm  order %5.2f  e/d %5.2f  (e - e')/d %5.2f", 1e3 * distance, order,
                  estimate / distance, (estimate - finest.report.discretisation_error) / distance);
      before = distance;
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::string scene, folder;
  double finest = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--meshes") == 0 && i + 1 < argc)
      folder = argv[++i];
    else if (std::strcmp(argv[i], "--finest") == 0 && i + 1 < argc)
      finest = 1e-3 * std::atof(argv[++i]);
    else
      scene = argv[i];
  }
  bool found = false;
  for (const RefinementScene& study : refinement_scenes()) {
    if (!scene.empty() && study.name != scene) continue;
    found = true;
    print_distances(study, drapes_of(study, finest, folder));
  }
  if (!found) std::fprintf(stderr, "no scene '%s'\n", scene.c_str());
  return found ? 0 : 2;
}
