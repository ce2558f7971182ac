#include "engine/experiments/fit_fabric.h"

#include "engine/scene/problem.h"
#include "schemas/parse_json.h"
#include "schemas/problem.h"
#include "schemas/read_measurements.h"
#include "schemas/write_fabric_fit.h"
#include "server/command/commands.h"
#include "server/command/fit_table.h"
#include "server/command/result_files.h"
#include "server/command/run_monitor.h"
#include "server/queue/run_outcome.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

constexpr std::size_t kMeasurementsLimit = 1U << 20;  // bytes

std::string not_fitted_document(const FabricFit& fit) {
  return failure_document(
      422, "not_fitted",
      "No fabric answers to these measurements (" + fit.stop_reason + "); the report tells how near it came.");
}

int fit_to_files(const FitFabricArguments& arguments, RunMonitor& monitor) {
  const nlohmann::json document = parse_json(read_input_file(arguments.measurements, kMeasurementsLimit));
  const FabricFit fit = fit_fabric(read_measurements(document), arguments.threads, monitor);
  monitor.clear_bar();
  if (!arguments.report.empty()) write_atomically(arguments.report, write_fabric_fit(fit).dump(2) + "\n");
  const bool fitted = fit.status == "fitted", to_file = !arguments.out.empty();
  std::fputs(fit_table(fit).c_str(), to_file ? stdout : stderr);
  if (!fitted) {
    std::fprintf(stderr, "%s\n", not_fitted_document(fit).c_str());
    return static_cast<int>(RunExit::not_converged);
  }
  const std::string fabric = write_fabric(fit, document).dump(2) + "\n";
  if (to_file)
    write_atomically(arguments.out, fabric);
  else
    std::fputs(fabric.c_str(), stdout);
  return static_cast<int>(RunExit::done);
}

}  // namespace

int run_fit_fabric(const FitFabricArguments& arguments) {
  catch_stop_signals();
  RunMonitor monitor(-1);
  try {
    return fit_to_files(arguments, monitor);
  } catch (const InputError& error) {
    monitor.clear_bar();
    std::fprintf(stderr, "%s\n", problem_document(error).dump(2).c_str());
    return static_cast<int>(RunExit::bad_input);
  } catch (const Cancelled&) {
    return static_cast<int>(RunExit::cancelled);
  }
}

}  // namespace toile
