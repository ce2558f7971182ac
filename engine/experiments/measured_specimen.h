#pragma once
// A laboratory's specimen, tested again by simulation.

#include "engine/monitor.h"
#include "engine/scene/fabric_measurements.h"

#include <optional>
#include <variant>
#include <vector>

namespace toile {

/// Coarse: 8 edges along an overhang, 40 along a loop, 5 across a strip. Fine: twice as many.
enum class SpecimenMesh { coarse, fine };

using MeasuredTest = std::variant<MeasuredPull, MeasuredCantilever, MeasuredLoop>;

/// What the specimen of a fabric shows at each reading of the test: forces [N/m], the angle [rad], the drop [m] or the
/// height [m]; nothing where it came to no equilibrium or the fabric can't be simulated. The shorter of their given
/// width and their overhang, or an eighth of the loop, is how wide bent strips are made: a wider one bends alike.
std::optional<std::vector<double>> test_again(const MeasuredTest& test, Direction direction, const Fabric& fabric,
                                              SpecimenMesh mesh, Monitor& monitor);

/// The same on an ever finer mesh, by the meshes' order of convergence, which is 1 (free edges, clamps, and yarns that
/// end in a grip): 2 fine − coarse. Against closed forms and the elastica: pulls along warp and weft 0.1 %; cantilevers
/// 0.2° at 41.5°, which are 1 % of D; loops, whose height converges faster at first (so that coarser meshes would be
/// extrapolated too far), 0.05 % of the height at ρ g L³/D from 30 to 3000, which are up to 4 % of D from 300 on. Pulls
/// on the bias: 2 %, as sequences of meshes up to 40 edges wide differ.
std::vector<double> extrapolated(const std::vector<double>& coarse, const std::vector<double>& fine);

}  // namespace toile
