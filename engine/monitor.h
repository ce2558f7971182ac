#pragma once
// How a long drape tells what it is doing, and how it is told to stop.

#include <string_view>

namespace toile {

/// What the engine is doing at one instant.
struct Progress {
  std::string_view stage;       ///< "mesh", "body", "assemble", "relax", "drape", "measure"
  double simulated_time_s = 0;  ///< of the drape stage
  double kinetic_energy_j = 0;  ///< of the cloth
  long contacts = 0;            ///< active contact stencils
  double fraction_done = 0;     ///< estimate over the whole run, 0 to 1, never falling
};

/// Receives progress at least twice a second and may cancel. Polled once per sewing iteration and once per Newton
/// iteration, always from the thread that called drape(); implementations need not be thread-safe.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// Returns false to cancel; the engine then throws Cancelled within a step.
  virtual bool report(const Progress& progress) = 0;
};

/// Thrown by the engine when a Monitor answered false.
struct Cancelled {};

}  // namespace toile
