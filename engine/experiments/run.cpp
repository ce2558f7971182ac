#include "engine/experiments/run.h"

#include "engine/experiments/cantilever.h"
#include "engine/experiments/cusick_drape.h"
#include "engine/experiments/pear_loop.h"
#include "engine/experiments/uniaxial.h"

namespace toile {
namespace {

CusickResult carry_out(const CusickDrape& e, int threads, Monitor& monitor) { return hang(e, threads, monitor); }
CantileverResult carry_out(const Cantilever& e, int threads, Monitor& monitor) {
  return bend_over(e, threads, monitor);
}
UniaxialResult carry_out(const UniaxialTest& e, int threads, Monitor& monitor) { return pull(e, threads, monitor); }
PearLoopResult carry_out(const PearLoop& e, int threads, Monitor& monitor) { return hang_loop(e, threads, monitor); }

}  // namespace

Drape run_experiment(const Experiment& experiment, int threads, Monitor& monitor) {
  std::vector<Problem> problems = experiment_problems(experiment);
  if (!problems.empty()) throw InputError(std::move(problems));
  return std::visit(
      [&](const auto& e) {
        auto result = carry_out(e, threads, monitor);
        result.drape.report.experiment = std::move(result.report);
        return std::move(result.drape);
      },
      experiment);
}

}  // namespace toile
