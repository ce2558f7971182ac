// Strips of a fabric that is given by force-strain readings, pulled as in the laboratory through the solver: meshed
// panels, free sides, clamps that let the ends narrow. What comes out must be what was read.

#include "engine/scene/stretch_test.h"
#include "tests/validation/pulled_strip.h"

#include <iostream>

using namespace toile;
using namespace toile::test;

namespace {

/// Readings of a woven cloth in the manner of a tensile curve: crimp straightens first, then yarns are pulled.
const StretchTest kReadings{{{0.01, 3}, {0.02, 9}, {0.04, 45}, {0.06, 140}, {0.08, 300}},
                            {{0.02, 4}, {0.04, 12}, {0.08, 60}, {0.12, 200}},
                            {{0.04, 3}, {0.08, 9}, {0.12, 24}, {0.16, 60}}};

Fabric measured_fabric() {
  Fabric fabric = isotropic_fabric(0.15, 1000, 50, 0, 1e-6);
  apply_stretch_test(kReadings, 0.2, "", fabric);
  return fabric;
}

void reproduces(const std::vector<ForceStrain>& readings, double grain, const char* direction) {
  const Fabric fabric = measured_fabric();
  for (const ForceStrain& reading : readings) {
    const PulledStrip ours = pull_strip(fabric, grain, 1 + reading.strain);
    std::cout << direction << " at " << 100 * reading.strain << " %: reference " << reading.force << " N/m, ours "
              << ours.force_per_width << ", error " << 100 * (ours.force_per_width / reading.force - 1) << " %\n";
    EXPECT_NEAR(ours.force_per_width, reading.force, 0.01 * reading.force) << direction << " " << reading.strain;
  }
}

}  // namespace

TEST(MeasuredStretchReference, WarpStripAnswersWithItsReadings) { reproduces(kReadings.warp, 0, "warp"); }
TEST(MeasuredStretchReference, WeftStripAnswersWithItsReadings) { reproduces(kReadings.weft, 90, "weft"); }
TEST(MeasuredStretchReference, BiasStripAnswersWithItsReadings) { reproduces(kReadings.bias, 45, "bias"); }
