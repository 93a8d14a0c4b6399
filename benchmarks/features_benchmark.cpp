// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Normals, FPFH and two-nearest matching beside PCL and FLANN (where PCL is installed), on two scans:
//
//   LOOPMARK_BENCH_SCANS=a.pcd,b.pcd bench_features
//
// without the variable on two synthetic yards. Both sides use the threads named in the benchmark's argument.
#include <benchmark/benchmark.h>

#include <cstdlib>

#include "features/rough_yard.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/features/fpfh.hpp"
#include "loopmark/features/normals.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/matching/nearest_two.hpp"
#include "peer_features.hpp"

namespace loopmark::benchmarks {
namespace {

struct Scan3 {
  std::vector<Eigen::Vector3f> points, normals;
  search::DescriptorMatrix descriptors;
};

constexpr double kVoxel = 0.3;
constexpr std::size_t kDescriptors = 15000;

std::vector<Eigen::Vector3f> load(std::size_t which) {
  const char* given = std::getenv("LOOPMARK_BENCH_SCANS");
  if (given == nullptr) {
    auto points = testing_support::rough_yard(20000, which + 1);
    for (Eigen::Vector3f& p : points) {
      p *= 4.0F;
    }
    return points;
  }
  const std::string both = given;
  const std::size_t comma = both.find(',');
  return io::read_point_file(which == 0 ? both.substr(0, comma) : both.substr(comma + 1)).cloud.points;
}

Scan3 prepare(std::size_t which) {
  Scan3 scan;
  const auto raw = load(which);
  std::vector<Eigen::Vector3f> small;
  for (const std::size_t i : cloud::voxel_first_indices(raw, kVoxel)) {
    small.push_back(raw[i]);
  }
  const auto normals = features::estimate_normals(small, {}).vectors;
  for (std::size_t i = 0; i < small.size(); ++i) {
    if (!normals[i].isZero()) {
      scan.points.push_back(small[i]);
      scan.normals.push_back(normals[i]);
    }
  }
  std::vector<std::size_t> wanted;
  const std::size_t count = std::min(kDescriptors, scan.points.size());
  for (std::size_t k = 0; k < count; ++k) {
    wanted.push_back(k * scan.points.size() / count);
  }
  scan.descriptors = features::fpfh(scan.points, scan.normals, {}, wanted);
  return scan;
}

const Scan3& scan(std::size_t which) {
  static const Scan3 scans[2] = {prepare(0), prepare(1)};
  return scans[which];
}

void ours_normals(benchmark::State& state) {
  set_thread_count(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(features::estimate_normals(scan(0).points, {}));
  }
  state.counters["points"] = static_cast<double>(scan(0).points.size());
}

void ours_fpfh(benchmark::State& state) {
  set_thread_count(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(features::fpfh(scan(0).points, scan(0).normals, {}));
  }
}

void ours_nearest_two(benchmark::State& state) {
  set_thread_count(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(matching::nearest_two(scan(0).descriptors, scan(1).descriptors));
  }
  state.counters["rows"] = static_cast<double>(scan(0).descriptors.rows());
}

void pcl_fpfh(benchmark::State& state) {
  for (auto _ : state) {
    if (!peer_fpfh(scan(0).points, scan(0).normals, features::FpfhOptions{}.radius_m,
                   static_cast<int>(state.range(0)))) {
      state.SkipWithError("PCL is not installed");
    }
  }
}

void flann_nearest_two(benchmark::State& state) {
  for (auto _ : state) {
    if (!peer_nearest_two(scan(0).descriptors, scan(1).descriptors, static_cast<int>(state.range(0)))) {
      state.SkipWithError("FLANN is not installed");
    }
  }
}

BENCHMARK(ours_normals)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(ours_fpfh)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(pcl_fpfh)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(ours_nearest_two)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(flann_nearest_two)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopmark::benchmarks

BENCHMARK_MAIN();
