#pragma once
// The fabric of a cloth from what a laboratory measured of it: optimisation over the experiments of this folder.

#include "engine/fabric_fit.h"
#include "engine/monitor.h"
#include "engine/scene/fabric_measurements.h"

namespace toile {

/// Finds what was measured and leaves the rest as the base has it. Stretch first (uniaxial, bias extension, a shear
/// stiffness), then bending (cantilevers, loops, bending stiffnesses) with that stretch: a pulled strip stays in its
/// plane, and a bent one hardly stretches (under 1e-4), so neither waits for the other. Each part by fit_part().
/// `status` is "not_fitted" where a part did not converge, or the misfit is over five uncertainties in the mean (rms),
/// or no fabric can be as it was found (check_fabric()): then the fabric is the best that was found, and not to be
/// used. Throws InputError with all of measurement_problems(), and Cancelled. `monitor` is never called twice at a
/// time, but from several threads.
FabricFit fit_fabric(const FabricMeasurements& measurements, int threads, Monitor& monitor);

}  // namespace toile
