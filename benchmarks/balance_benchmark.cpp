// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Choosing a balanced set from many candidates, made up like those of drives: mostly straight on, from near to far. The
// arguments are candidates and pairs. What the candidates themselves cost, loopmark balance prints.
#include <benchmark/benchmark.h>

#include <cmath>

#include "loopmark/core/random.hpp"
#include "loopmark/pair_sets/balanced_selection.hpp"

namespace loopmark::benchmarks {
namespace {

std::vector<pair_sets::RegistrationPair> candidates(std::size_t count) {
  Rng rng(1);
  std::vector<pair_sets::RegistrationPair> pool;
  for (std::size_t i = 0; i < count; ++i) {
    const double yaw = 0.3 * std::pow(rng.normal(), 3);
    const Eigen::Vector3d t(-90.0 * rng.uniform() * rng.uniform(), 3.0 * rng.normal(), 0.3 * rng.normal());
    const int session = static_cast<int>(i % 20);
    const int frame = static_cast<int>(i);
    pool.push_back(pair_sets::make_pair({session, frame, frame + 1, session}, pose_from_yaw(yaw, t), 0.5, 0.5));
  }
  return pool;
}

void select(benchmark::State& state) {
  const auto pool = candidates(static_cast<std::size_t>(state.range(0)));
  std::size_t chosen = 0;
  for (auto _ : state) {
    chosen = pair_sets::select_balanced(pool, static_cast<std::size_t>(state.range(1)), {}).size();
  }
  state.counters["chosen"] = static_cast<double>(chosen);
}

BENCHMARK(select)
    ->Args({4'000, 1'000})
    ->Args({40'000, 10'000})
    ->Args({400'000, 10'000})
    ->Args({1'000'000, 10'000})
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopmark::benchmarks

BENCHMARK_MAIN();
