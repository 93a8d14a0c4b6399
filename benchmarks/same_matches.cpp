// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Our estimators and those of other libraries on the same matches (our FPFH, or with fsc our Fourier shape contexts;
// mutual) of a set of pairs: recall (RE < 5 deg, TE < 0.6 m) before and after the same ICP, wall and processor time a
// pair.
//
//   same_matches PAIRS.txt LOGS SESSIONS.txt [EVERY [ground|no_ground|fsc [SKIP]]]
//
// LOGS/<session name>/velodyne/%06d.{pcd,bin}; SESSIONS.txt: "number name" lines. EVERY: only each n-th pair. SKIP:
// estimators whose name has this in it are left out.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/estimation/gnc.hpp"
#include "loopmark/estimation/ransac.hpp"
#include "loopmark/estimation/spatial_consistency.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/pair_sets/pair_set.hpp"
#include "peers.hpp"

namespace loopmark::benchmarks {
namespace {

struct Row {
  std::size_t right = 0;
  std::size_t right_after_icp = 0;
  std::vector<double> wall, processor;
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::map<int, std::string> read_sessions(const std::string& path) {
  std::map<int, std::string> names;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    int number = 0;
    std::string name;
    if (words >> number >> name) {
      names[number] = name;
    }
  }
  return names;
}

PointCloud read_scan(const std::filesystem::path& log, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%06d", frame);
  std::filesystem::path path = log / "velodyne" / (std::string(name) + ".pcd");
  if (!std::filesystem::exists(path)) {
    path.replace_extension(".bin");
  }
  return io::read_point_file(path).cloud;
}

std::vector<NamedEstimator> estimators() {
  std::vector<NamedEstimator> all = {
      {"ransac (PROSAC, ELC, LO)",
       [](const estimation::PointPairs& p) {
         return estimation::ransac(p, feature_registration::named_algorithm("ransac_mutual").ransac).T_target_source;
       }},
      {"ransac, 100 k",
       [](const estimation::PointPairs& p) {
         estimation::RansacOptions o;
         o.max_iterations = 100'000;
         return estimation::ransac(p, o).T_target_source;
       }},
      {"gnc_clique", [](const estimation::PointPairs& p) { return estimation::gnc_clique(p).T_target_source; }},
      {"gnc_core",
       [](const estimation::PointPairs& p) {
         return estimation::gnc_clique(p, feature_registration::named_algorithm("gnc_core").gnc).T_target_source;
       }},
      {"sc2", [](const estimation::PointPairs& p) { return estimation::spatial_consistency(p).T_target_source; }},
  };
  for (const auto& peers : {open3d_estimators(), pcl_estimators()}) {
    all.insert(all.end(), peers.begin(), peers.end());
  }
  return all;
}

bool is_right(const Pose& T, const Pose& truth) {
  const PoseError error = pose_error(T, truth);
  return error.translation_m < 0.6 && error.rotation_deg < 5.0;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value / static_cast<double>(values.size());
  }
  return sum;
}

void run_pair(const estimation::PointPairs& matches, const refinement::Surface& source,
              const refinement::IcpTarget& target, const Pose& truth, const std::vector<NamedEstimator>& all,
              std::vector<Row>& rows) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double processor = processor_seconds();
    const auto start = std::chrono::steady_clock::now();
    const Pose T = all[k].estimate(matches);
    rows[k].wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    rows[k].processor.push_back(processor_seconds() - processor);
    rows[k].right += is_right(T, truth) ? 1U : 0U;
    rows[k].right_after_icp += is_right(refinement::icp(source, target, T).T_target_source, truth) ? 1U : 0U;
  }
}

void print(const std::vector<NamedEstimator>& all, const std::vector<Row>& rows) {
  std::printf("%-26s %8s %8s | %10s %10s | %10s %10s  (ms a pair; recall in %%)\n", "on the same matches", "recall",
              "with ICP", "wall med.", "wall mean", "cpu med.", "cpu mean");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double n = static_cast<double>(rows[k].wall.size());
    std::printf("%-26s %8.1f %8.1f | %10.2f %10.2f | %10.2f %10.2f\n", all[k].name.c_str(),
                100.0 * static_cast<double>(rows[k].right) / n,
                100.0 * static_cast<double>(rows[k].right_after_icp) / n, 1e3 * median(rows[k].wall),
                1e3 * mean(rows[k].wall), 1e3 * median(rows[k].processor), 1e3 * mean(rows[k].processor));
  }
}

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: same_matches PAIRS.txt LOGS SESSIONS.txt [EVERY [ground|no_ground|fsc [SKIP]]]\n");
    return 2;
  }
  const auto every = static_cast<std::size_t>(argc > 4 ? std::max(1, std::atoi(argv[4])) : 1);
  feature_registration::FeatureRegistrationOptions options = feature_registration::named_algorithm("ransac_mutual");
  options.descriptor = argc > 5 && std::string(argv[5]) == "fsc" ? "fsc" : "fpfh";
  options.match_ground = !(argc > 5 && std::string(argv[5]) == "no_ground");
  const auto pairs = pair_sets::read_pair_set(argv[1]);
  const auto names = read_sessions(argv[3]);
  auto all = estimators();
  if (argc > 6) {
    std::erase_if(all, [&](const NamedEstimator& e) { return e.name.find(argv[6]) != std::string::npos; });
  }
  std::vector<Row> rows(all.size());
  std::size_t used = 0;
  double matched = 0.0;
  for (std::size_t i = 0; i < pairs.size(); i += every) {
    const std::filesystem::path log = std::filesystem::path(argv[2]) / names.at(pairs[i].key.session);
    const feature_registration::DescribedScan source =
        feature_registration::describe_scan(read_scan(log, pairs[i].key.source), options);
    const feature_registration::DescribedScan target =
        feature_registration::describe_scan(read_scan(log, pairs[i].key.target), options);
    const matching::Correspondences mutual = matching::keep_best(
        matching::keep_mutual(
            matching::correspondences_of(matching::nearest_two(source.descriptors, target.descriptors))),
        0);
    const estimation::PointPairs matches = estimation::PointPairs::of(mutual, source.keypoints, target.keypoints);
    run_pair(matches, source.surface, refinement::IcpTarget(target.surface, 0.6), pairs[i].T_target_source, all, rows);
    matched += static_cast<double>(matches.size());
    ++used;
  }
  std::printf("%zu pairs, %.0f mutual matches a pair on average, %zu threads\n", used,
              matched / static_cast<double>(std::max<std::size_t>(1, used)), thread_count());
  print(all, rows);
  return 0;
}

}  // namespace
}  // namespace loopmark::benchmarks

int main(int argc, char** argv) {
  try {
    return loopmark::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
