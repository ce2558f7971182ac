// Finding what touches: proximity of two layers, contacts with a body, the exact test for crossings.

#include "engine/contact/body_contacts.h"
#include "engine/contact/proximity.h"
#include "engine/parallel/thread_limit.h"
#include "engine/quality/intersections.h"
#include "engine/quality/penetration.h"
#include "tests/benchmark/sheet_on_ball.h"

#include <benchmark/benchmark.h>

#include <random>

namespace {

using namespace toile;

/// Arguments: threads, and whether the list of pairs has to be found anew.
void ProximityUpdate(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const Cloth cloth = test::two_layers();
  Proximity proximity(make_collision_mesh(cloth, 0), 0);
  Positions x = cloth.x;
  proximity.update(x);
  for (auto _ : state) {
    if (state.range(1) != 0) {
      state.PauseTiming();
      for (Vec3& p : x) p.y() += 0.1;  // farther than the list reaches
      state.ResumeTiming();
    }
    proximity.update(x);
  }
  state.counters["vertices"] = static_cast<double>(cloth.x.size());
  state.counters["contacts"] = static_cast<double>(proximity.contacts().size());
}
BENCHMARK(ProximityUpdate)
    ->ArgsProduct({{1, 2}, {0, 1}})
    ->ArgNames({"threads", "anew"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void BodyContacts(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const test::SheetOnBall scene;
  std::size_t found = 0;
  for (auto _ : state) found = body_contacts(scene.mesh, scene.ball, scene.cloth.x, {3e-3, 0.3}).size();
  state.counters["contacts"] = static_cast<double>(found);
}
BENCHMARK(BodyContacts)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMicrosecond)->UseRealTime();

/// Points within 50 mm of a dress form's surface.
void BodySampling(benchmark::State& state) {
  const BodyField form = make_body_field({DressFormBody{}, 0.3}, 0.015);
  const Positions surface = form.surface().vertices;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-0.05, 0.05);
  Positions points;
  for (std::size_t v = 0; v < surface.size(); ++v)
    points.push_back(surface[v] + Vec3(off(random), off(random), off(random)));
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(form.sample(p));
  state.SetItemsProcessed(state.iterations() * static_cast<long>(points.size()));
}
BENCHMARK(BodySampling)->Unit(benchmark::kMillisecond);

void BodyField15mm(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_body_field({DressFormBody{}, 0.3}, 0.015));
}
BENCHMARK(BodyField15mm)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(3);

void SelfIntersections(benchmark::State& state) {
  const Cloth cloth = test::two_layers();
  std::size_t found = 0;
  for (auto _ : state) found = self_intersections(cloth.x, cloth.triangles).size();
  state.counters["triangles"] = static_cast<double>(cloth.triangles.size());
  state.counters["crossings"] = static_cast<double>(found);
}
BENCHMARK(SelfIntersections)->Unit(benchmark::kMillisecond)->UseRealTime();

void DeepestPenetration(benchmark::State& state) {
  const test::SheetOnBall scene;
  for (auto _ : state) benchmark::DoNotOptimize(deepest_penetration(scene.ball, scene.cloth.x, scene.cloth.triangles));
}
BENCHMARK(DeepestPenetration)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
