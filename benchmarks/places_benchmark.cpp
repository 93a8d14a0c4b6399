// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Retrieval among many keyframes, on synthetic descriptors of the real size (512 numbers).
//
//   bench_places
//
// Counter: share of queries whose first answer is that of comparing with every place.
#include <benchmark/benchmark.h>

#include "loopmark/places/place_index.hpp"
#include "places/synthetic_descriptors.hpp"
#include "places/towns.hpp"

namespace loopmark {
namespace {

void query_places(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const std::vector<places::PlaceDescriptor> drive = testing::drive_descriptors(count, 1);
  places::PlaceIndex index;
  for (std::size_t i = 0; i < count; ++i) {
    index.add(i, drive[i]);
  }
  constexpr std::size_t kQueries = 100;
  std::vector<places::PlaceDescriptor> queries;
  double agreed = 0.0;
  for (std::size_t q = 0; q < kQueries; ++q) {
    queries.push_back(testing::seen_again(drive[q * count / kQueries], 1000 + q));
    agreed += index.query(queries.back(), 1)[0].id == index.query_exactly(queries.back(), 1)[0].id ? 1.0 : 0.0;
  }
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(index.query(queries[next++ % kQueries], 25));
  }
  state.counters["agrees_with_all_compared"] = agreed / static_cast<double>(kQueries);
}

void compute_signature(benchmark::State& state) {
  const std::vector<Eigen::Vector3f> points = testing::Town(1).seen_from(0, 0, 0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(places::place_descriptor(points));
  }
}

BENCHMARK(query_places)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(compute_signature)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopmark

BENCHMARK_MAIN();
