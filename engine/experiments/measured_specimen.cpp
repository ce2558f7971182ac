#include "engine/experiments/measured_specimen.h"

#include "engine/experiments/cantilever.h"
#include "engine/experiments/pear_loop.h"
#include "engine/experiments/uniaxial.h"

#include <algorithm>

namespace toile {
namespace {

constexpr double kAcross = 5;             // edges across a pulled strip, coarse
constexpr double kMostAlong = 40;         // edges along a pulled strip, coarse
constexpr double kOverhang = 8;           // edges along an overhang, coarse
constexpr double kLoop = 40;              // edges along a loop, coarse
constexpr double kLoopSlender = 1.0 / 8;  // widest over its length
constexpr int kAllThreads = 0;

using Readings = std::optional<std::vector<double>>;

struct Simulate {
  Direction direction;
  const Fabric& fabric;
  double refinement;
  Monitor& monitor;

  Readings operator()(const MeasuredPull& test) const {
    UniaxialTest again{fabric, direction, test.length, test.width, {}, 0};
    for (const ForceStrain& reading : test.readings) again.strains.push_back(reading.strain);
    const double coarse = std::max(std::min(test.width, test.length) / kAcross, test.length / kMostAlong);
    again.edge_length = std::min(coarse, 0.5 * std::min(test.width, test.length)) / refinement;
    const UniaxialResult result = pull(again, kAllThreads, monitor);
    if (result.drape.report.status != "converged") return {};
    std::vector<double> forces;
    for (const UniaxialReport::Reading& reading : result.report.curve) forces.push_back(reading.force);
    return forces;
  }

  Readings operator()(const MeasuredCantilever& test) const {
    Cantilever again{fabric, direction, std::min(test.width, test.overhang), test.overhang, 0};
    again.edge_length = std::min(test.overhang / kOverhang, 0.5 * again.width) / refinement;
    const CantileverResult result = bend_over(again, kAllThreads, monitor);
    if (result.drape.report.status != "converged") return {};
    const bool drop = test.reading == MeasuredCantilever::Reading::drop;
    return std::vector<double>{drop ? result.report.drop : result.report.angle};
  }

  Readings operator()(const MeasuredLoop& test) const {
    PearLoop again{fabric, direction, test.length, std::min(test.width, kLoopSlender * test.length), 0};
    again.edge_length = std::min(test.length / kLoop, 0.5 * again.width) / refinement;
    const PearLoopResult result = hang_loop(again, kAllThreads, monitor);
    if (result.drape.report.status != "converged") return {};
    return std::vector<double>{result.report.height};
  }
};

}  // namespace

Readings test_again(const MeasuredTest& test, Direction direction, const Fabric& fabric, SpecimenMesh mesh,
                    Monitor& monitor) {
  try {
    return std::visit(Simulate{direction, fabric, mesh == SpecimenMesh::fine ? 2.0 : 1.0, monitor}, test);
  } catch (const InputError&) {
    return {};
  }
}

std::vector<double> extrapolated(const std::vector<double>& coarse, const std::vector<double>& fine) {
  std::vector<double> values;
  for (std::size_t i = 0; i < coarse.size(); ++i) values.push_back(2 * fine[i] - coarse[i]);
  return values;
}

}  // namespace toile
