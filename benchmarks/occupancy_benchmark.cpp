// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The occupancy map against one octomap::OcTree::insertPointCloud a keyframe, in the same run on the same clouds.
//
//   bench_occupancy                                     made-up street, 100 k points a scan
//   LOOPMARK_BENCHMARK_LOG=FOLDER bench_occupancy       every third scan of a log that has poses
//
// Counters: seconds a scan of both, how many times faster, and the share of octomap's leaves in the same state.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "occupancy/street.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kScans = 12;

std::vector<testing::StreetScan> scans_to_map() {
  const char* folder = std::getenv("LOOPMARK_BENCHMARK_LOG");
  if (folder == nullptr) {
    return testing::street(kScans, 100000);
  }
  const std::unique_ptr<io::DriveLog> log = io::open_log(folder);
  const std::vector<Pose> truth = log->truth();
  std::vector<testing::StreetScan> scans;
  for (std::size_t i = 0; i < truth.size() && scans.size() < kScans; i += 3) {
    scans.push_back({log->read(i).cloud.points, truth[i]});
  }
  return scans;
}

double share_of_equal_leaves(const octomap::OcTree& oracle, const std::filesystem::path& ot) {
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(ot.string()));
  const auto* tree = dynamic_cast<const octomap::OcTree*>(read.get());
  std::size_t equal = 0;
  std::size_t leaves = 0;
  for (auto leaf = oracle.begin_leafs(); leaf != oracle.end_leafs(); ++leaf, ++leaves) {
    const octomap::OcTreeNode* ours = tree->search(leaf.getKey());
    equal += ours != nullptr && ours->getLogOdds() == leaf->getLogOdds() ? 1 : 0;
  }
  return static_cast<double>(equal) / static_cast<double>(leaves);
}

void occupancy_against_octomap(benchmark::State& state) {
  const std::vector<testing::StreetScan> scans = scans_to_map();
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const occupancy::OccupancyOptions options;
  const auto count = static_cast<double>(scans.size());
  for (auto _ : state) {
    Stopwatch watch;
    occupancy::OccupancyMapBuilder builder(options, folder);
    for (const testing::StreetScan& scan : scans) {
      builder.insert(scan.points, scan.T_map_sensor);
    }
    builder.write(folder / "bench.bt", folder / "bench.ot");
    const double ours = watch.seconds();
    watch.reset();
    octomap::OcTree oracle(options.resolution_m);
    for (const testing::StreetScan& scan : scans) {
      testing::insert_with_octomap(oracle, scan, options.max_range_m);
    }
    const double octomaps = watch.seconds();
    state.SetIterationTime(ours);
    state.counters["loopmark_s_per_scan"] = ours / count;
    state.counters["octomap_s_per_scan"] = octomaps / count;
    state.counters["times_faster"] = octomaps / ours;
    oracle.prune();
    state.counters["equal_leaves"] = share_of_equal_leaves(oracle, folder / "bench.ot");
  }
}

BENCHMARK(occupancy_against_octomap)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace loopmark

BENCHMARK_MAIN();
