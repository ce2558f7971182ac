#pragma once
// One part of a fabric's fit, whose parameters its specimens tell: those of stretch, or those of bending.

#include "engine/experiments/fabric_model.h"
#include "engine/experiments/measured_specimen.h"
#include "engine/fabric_fit.h"

#include <functional>
#include <string>
#include <vector>

namespace toile {

/// A specimen with the readings taken of it, in the order of test_again().
struct PartSpecimen {
  MeasuredTest test;
  Direction direction;
  std::vector<MisfitRow> rows;
};

/// A stiffness that was measured as such.
struct DirectReading {
  Direction direction;
  MisfitRow row;
};

struct PartProblem {
  std::string name;
  std::vector<FitParameter> parameters;
  std::vector<PartSpecimen> specimens;
  std::vector<DirectReading> direct;
  double step;  ///< of the logarithms, for differences
  /// Whether a specimen along warp or weft depends on the parameters of its own direction alone.
  bool own_direction;
  /// The model with these values. May throw InputError.
  std::function<FabricModel(const Numbers& values)> model;
};

struct PartSolution {
  FitPart part;
  Numbers values;
  std::vector<MisfitRow> rows;  ///< with what the fabric of these values does; empty where that could not be found
  long simulations = 0;
};

/// Levenberg–Marquardt over the logarithms of the parameters, on coarse meshes. The meshes' error is not fitted: what
/// specimens show is multiplied by the ratio of extrapolated() to coarse readings, measured at the start and anew at
/// each solution until that ratio has settled to a quarter of every reading's uncertainty (defect correction); so
/// `rows` are those of ever finer meshes. What a specimen did is remembered by the parameters that it depends on.
/// Different specimens run in parallel; the result does not depend on how many. Throws Cancelled.
PartSolution fit_part(const PartProblem& problem, Monitor& monitor);

}  // namespace toile
