// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulate_pairs.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/pair_sets/pair_set.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/output_folder.hpp"

namespace loopmark::app {
namespace {

using namespace simulation;

constexpr const char* kReadme = R"(Simulated pairs of LiDAR scans with exact motions.

pairs.txt      a balanced set: session, source scan, target scan, T_target_source (4x4, row-major), x y z roll pitch yaw,
               overlap, overlap_symmetric
negatives.txt  pairs of different places without overlap; about half of them in blocks that look alike
sessions.txt   name of the folder of each session (one town each)
TOWN/velodyne  x y z intensity as float32; the sensor stood while it swept, so scans need no compensation
TOWN/poses.txt T_town_lidar of each scan, 3x4 row-major
)";

std::string scan_name(std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06zu.bin", index);
  return name.data();
}

/// Share `k` of `count` things split evenly into `parts`.
std::size_t share(std::size_t count, std::size_t parts, std::size_t k) {
  return count / parts + (k < count % parts ? 1 : 0);
}

struct PairSet {
  std::vector<pair_sets::RegistrationPair> pairs;
  std::vector<pair_sets::PairKey> negatives;
  std::string sessions = "index name\n";
};

void add_town(const SimulatePairsArguments& a, std::size_t k, const std::filesystem::path& folder, PairSet& set) {
  simulation::TownOptions town_options = a.town;
  town_options.seed += k;
  const std::string name = "town_" + std::to_string(town_options.seed);
  const std::filesystem::path scans = folder / name / "velodyne";
  std::filesystem::create_directories(scans);
  simulation::PairOptions options = a.pairs;
  options.pairs = share(a.pairs.pairs, a.towns, k);
  options.negatives = share(a.pairs.negatives, a.towns, k);
  const simulation::Town town = simulation::make_town(town_options);
  const simulation::PairSample sample = simulation::sample_pairs(
      town, options,
      [&](std::size_t index, const PointCloud& cloud) { io::write_bin(scans / scan_name(index), cloud); });
  io::write_kitti(folder / name / "poses.txt", sample.T_town_lidar);
  const int session = static_cast<int>(k);
  set.sessions += std::to_string(k) + " " + name + "\n";
  for (const simulation::SampledPair& pair : sample.pairs) {
    set.pairs.push_back(
        pair_sets::make_pair({session, static_cast<int>(pair.source), static_cast<int>(pair.target), session},
                             pair.T_target_source, pair.overlap, pair.overlap_symmetric));
  }
  for (const auto& [first, second] : sample.negatives) {
    set.negatives.push_back({session, static_cast<int>(first), static_cast<int>(second), session});
  }
}

void print_summary(const SimulatePairsArguments& a, const PairSet& set, double seconds) {
  std::array<std::size_t, 7> bins{};
  double farthest = 0.0;
  for (const pair_sets::RegistrationPair& pair : set.pairs) {
    const double at = (pair.overlap_symmetric - a.pairs.min_overlap) / (a.pairs.max_overlap - a.pairs.min_overlap);
    ++bins[std::min<std::size_t>(6, static_cast<std::size_t>(7.0 * at))];
    farthest = std::max(farthest, pair.T_target_source.translation().norm());
  }
  std::printf("%s: %zu pairs of %zu towns, up to %.0f m apart, and %zu negatives, in %.0f s\n", a.output.c_str(),
              set.pairs.size(), a.towns, farthest, set.negatives.size(), seconds);
  std::printf("pairs by symmetric overlap, in seven equal bins from %.2f to %.2f:", a.pairs.min_overlap,
              a.pairs.max_overlap);
  for (const std::size_t count : bins) {
    std::printf(" %zu", count);
  }
  std::printf("\n");
  if (set.pairs.size() < a.pairs.pairs) {
    std::printf("fewer than the %zu asked for: some overlaps are too rare with this sensor\n", a.pairs.pairs);
  }
}

}  // namespace

int simulate_pairs(const SimulatePairsArguments& a) {
  check(a.pairs);
  require_option(a.towns >= 1 && a.towns <= a.pairs.pairs, "--towns", "must lie between 1 and the number of pairs");
  const Stopwatch watch;
  storage::OutputFolder output(a.output);
  PairSet set;
  for (std::size_t k = 0; k < a.towns; ++k) {
    add_town(a, k, output.partial(), set);
  }
  pair_sets::write_pair_set(output.partial() / "pairs.txt", set.pairs);
  pair_sets::write_negatives(output.partial() / "negatives.txt", set.negatives);
  storage::write_file_atomically(output.partial() / "sessions.txt", set.sessions);
  storage::write_file_atomically(output.partial() / "README.txt", kReadme);
  output.finish();
  print_summary(a, set, watch.seconds());
  return 0;
}

}  // namespace loopmark::app
