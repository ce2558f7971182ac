#pragma once
// From the numbers that a fit looks for to a fabric, and where to begin.

#include "engine/experiments/least_squares.h"
#include "engine/scene/fabric_measurements.h"

#include <vector>

namespace toile {

/// One number to be found, within the range of fabric.schema.json.
struct FitParameter {
  enum class Kind { modulus, curve_factor, bending };  ///< C or G [N/m]; a factor; D [N·m]
  Kind kind;
  Direction direction;
  double strain = 0;  ///< where the factor applies
  double start, low, high;
};

/// A fabric, and the readings of strips with free sides behind its stress curves.
struct FabricModel {
  Fabric fabric;
  StretchTest stretch;
};

/// The base with the weight, the thickness and the Poisson ratio that were given.
FabricModel base_model(const FabricMeasurements& measurements);

/// Of what was measured only. A direction pulled for a constant has its modulus, which starts from the closed form of
/// free sides. One pulled for its curve has the logarithm of the free strip's force over the measured one at its first,
/// middle and last strain (two readings: first and last), linear between: grips that keep the ends from narrowing, and
/// on the bias from shearing, change the force by a smooth factor. A shear stiffness measured as such has its modulus
/// where no bias strip tells it. Throws InputError where the bias is stiffer than warp and weft can be.
std::vector<FitParameter> stretch_parameters(const FabricMeasurements& measurements);

/// The model with these values of the stretch parameters. Throws InputError (stretch_test.h).
FabricModel with_stretch(const FabricMeasurements& measurements, const std::vector<FitParameter>& parameters,
                         const Numbers& values);

/// Of the directions that were measured. Starts: D as measured; Peirce's D = ρ g L³ cos(θ/2)/(8 tan θ) of a
/// cantilever's angle [Peirce 1930]; for a drop of the share u of the overhang, ρ g L³/D = 8 u/√(1 − u) + 0.37 u⁴/(1 −
/// u)², which is the elastica's within 15 % from 0.1 to 1000; for a loop whose height exceeds the weightless 0.4243 L
/// by the share q of what is possible, ρ g L³/D = 1300 q/(1 − q), which is right within a factor of 1.5. Bounds: a
/// factor of 20 from there.
std::vector<FitParameter> bending_parameters(const FabricMeasurements& measurements);

/// `model` with these values of the bending parameters. Where warp and weft were measured and bias was not, it is their
/// mean.
FabricModel with_bending(const FabricModel& model, const std::vector<FitParameter>& parameters, const Numbers& values);

/// Whether the bias bends as the mean of warp and weft because it was not measured.
bool bias_is_mean(const std::vector<FitParameter>& bending);

}  // namespace toile
