// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Rendering of whole sweeps of a drive, traffic included; counters: rays and sweeps a second of wall time.
//
//   bench_simulation
#include <benchmark/benchmark.h>

#include "loopmark/core/parallel.hpp"
#include "loopmark/simulation/sweep.hpp"

namespace loopmark::simulation {
namespace {

const Town& town() {
  static const Town made = make_town({});
  return made;
}

const World& world() {
  static const World made(town(), 1);
  return made;
}

void render_sweeps(benchmark::State& state, const char* sensor) {
  DriveOptions options;
  options.sensor = sensor;
  options.length_m = 200.0;
  const Drive drive(town(), options);
  const World& scene = world();
  set_thread_count(static_cast<std::size_t>(state.range(0)));
  constexpr std::size_t kSweeps = 16;
  std::size_t first = 0;
  for (auto _ : state) {
    parallel_for(kSweeps, [&](std::size_t k) {
      benchmark::DoNotOptimize(render_scan(scene, drive, (first + k) % drive.size()));
    });
    first += kSweeps;
  }
  const auto sweeps = static_cast<double>(kSweeps * static_cast<std::size_t>(state.iterations()));
  state.counters["sweeps/s"] = benchmark::Counter(sweeps, benchmark::Counter::kIsRate);
  state.counters["rays/s"] =
      benchmark::Counter(sweeps * static_cast<double>(drive.sensor().rays_per_sweep()), benchmark::Counter::kIsRate);
}

void build_town(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(make_town({}).mesh.size());
  }
}

void build_world(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(World(town(), 1).triangles());
  }
}

BENCHMARK_CAPTURE(render_sweeps, hdl64e, "hdl64e")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(render_sweeps, vlp16, "vlp16")
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(build_town)->Unit(benchmark::kMillisecond);
BENCHMARK(build_world)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopmark::simulation

BENCHMARK_MAIN();
