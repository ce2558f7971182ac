// One step of the accurate engine: a sheet of 10,000 vertices that lies on a ball, with its contacts.

#include "engine/contact/body_contacts.h"
#include "engine/contact/proximity.h"
#include "engine/parallel/thread_limit.h"
#include "engine/solve/backward_euler.h"
#include "tests/benchmark/sheet_on_ball.h"

#include <benchmark/benchmark.h>

namespace {

using namespace toile;

/// Argument: threads.
void SolverStep(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const test::SheetOnBall scene;
  const SolverOptions options;
  BackwardEuler solver(scene.cloth, options);
  const Kinematic free{std::vector<char>(scene.cloth.x.size(), 0), scene.cloth.x};
  const std::vector<Contact> contacts = body_contacts(scene.mesh, scene.ball, scene.cloth.x, {3e-3, 0.3});
  State moving{scene.cloth.x, Positions(scene.cloth.x.size(), Vec3::Zero())};
  StepTimes times;
  double newton = 0, cg = 0;
  for (auto _ : state) {
    state.PauseTiming();
    State now = moving;
    std::vector<Contact> touching = contacts;
    state.ResumeTiming();
    const StepOutcome outcome = solver.step(now, options.max_time_step, 1, touching, free, times);
    if (!outcome.accepted) state.SkipWithError("step not accepted");
    newton += outcome.newton_iterations;
    cg += outcome.cg_iterations;
  }
  const auto steps = static_cast<double>(state.iterations());
  state.counters["vertices"] = static_cast<double>(scene.cloth.x.size());
  state.counters["contacts"] = static_cast<double>(contacts.size());
  state.counters["newton"] = newton / steps;
  state.counters["cg"] = cg / steps;
}
BENCHMARK(SolverStep)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();

void SolverSetUp(benchmark::State& state) {
  const test::SheetOnBall scene;
  for (auto _ : state) benchmark::DoNotOptimize(BackwardEuler(scene.cloth, SolverOptions{}));
}
BENCHMARK(SolverSetUp)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
