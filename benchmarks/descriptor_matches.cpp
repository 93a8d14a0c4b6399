// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How many mutual matches of a descriptor are right (nearer than 0.6 m under the true motion) on a set of pairs, and
// the recall (RE < 5 deg, TE < 0.6 m) and the times of the paper's RANSAC (GPF(2)) and ICP on them.
//
//   descriptor_matches PAIRS.txt LOGS SESSIONS.txt [DESCRIPTOR [EVERY [PERTURBATIONS.txt]]]
//
// LOGS/<session name>/velodyne/%06d.{pcd,bin}; SESSIONS.txt: "number name" lines. EVERY: only each n-th pair.
// PERTURBATIONS.txt: motions by which the source points are moved first (the motions of PAIRS.txt are those before).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/pair_sets/pair_set.hpp"

namespace loopmark::benchmarks {
namespace {

constexpr double kNearM = 0.6;

struct Row {
  int session = 0;
  double keypoints = 0.0;
  double mutual = 0.0;
  double share = 0.0;  ///< of the mutual matches that are right
  bool right = false;
  std::map<std::string, double> seconds;
};

/// The value below which `share` of the values lie (nearest rank).
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(share * last + 0.5)];
}

double share_right(const feature_registration::DescribedScan& source, const feature_registration::DescribedScan& target,
                   const matching::Correspondences& mutual, const Pose& truth) {
  double right = 0.0;
  for (const matching::Correspondence& m : mutual) {
    const Eigen::Vector3d moved = truth * source.keypoints[m.source].cast<double>();
    right += (moved - target.keypoints[m.target].cast<double>()).norm() < kNearM ? 1.0 : 0.0;
  }
  return right / std::max(1.0, static_cast<double>(mutual.size()));
}

Row measured(const PointCloud& source_cloud, const PointCloud& target_cloud, const Pose& truth,
             const feature_registration::FeatureRegistrationOptions& options) {
  const auto source = feature_registration::describe_scan(source_cloud, options);
  const auto target = feature_registration::describe_scan(target_cloud, options);
  const auto matches = feature_registration::match_described(source, target);
  const auto result = feature_registration::register_matched(source, target, matches, options);
  const PoseError error = pose_error(result.T_target_source, truth);
  Row row;
  row.keypoints = static_cast<double>(source.keypoints.size());
  row.mutual = static_cast<double>(matches.mutual);
  row.share = share_right(source, target, matching::keep_mutual(matches.all), truth);
  row.right = result.found && error.translation_m < 0.6 && error.rotation_deg < 5.0;
  for (const auto* timings : {&source.timings, &target.timings, &result.timings}) {
    for (const registration::StageTime& time : *timings) {
      row.seconds[time.stage] += time.seconds;
      row.seconds["all"] += time.seconds;
    }
  }
  return row;
}

void print(const std::string& name, const std::vector<Row>& rows) {
  std::vector<double> keypoints, mutual, shares;
  double right = 0.0;
  double enough = 0.0;
  for (const Row& row : rows) {
    keypoints.push_back(row.keypoints);
    mutual.push_back(row.mutual);
    shares.push_back(100.0 * row.share);
    right += row.right ? 100.0 : 0.0;
    enough += row.share >= 0.05 ? 100.0 : 0.0;
  }
  const auto n = static_cast<double>(rows.size());
  std::printf("%-24s %5zu %9.0f %7.0f | %6.1f %6.1f %6.1f | %8.1f | %6.1f\n", name.c_str(), rows.size(),
              quantile(keypoints, 0.5), quantile(mutual, 0.5), quantile(shares, 0.5), quantile(shares, 0.25),
              quantile(shares, 0.05), enough / n, right / n);
}

void print_times(const std::vector<Row>& rows) {
  std::map<std::string, std::vector<double>> times;
  for (const Row& row : rows) {
    for (const auto& [stage, seconds] : row.seconds) {
      times[stage].push_back(1e3 * seconds);
    }
  }
  std::printf("ms a pair (both scans), median and 95 %%, %zu threads:", thread_count());
  for (const auto& [stage, ms] : times) {
    std::printf("  %s %.1f %.1f", stage.c_str(), quantile(ms, 0.5), quantile(ms, 0.95));
  }
  std::printf("\n");
}

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr,
                 "usage: descriptor_matches PAIRS.txt LOGS SESSIONS.txt [DESCRIPTOR [EVERY [PERTURBATIONS]]]\n");
    return 2;
  }
  feature_registration::FeatureRegistrationOptions options = feature_registration::named_algorithm("ransac_gpf");
  options.descriptor = argc > 4 ? argv[4] : options.descriptor;
  const auto every = static_cast<std::size_t>(argc > 5 ? std::max(1, std::atoi(argv[5])) : 1);
  const auto pairs = pair_sets::read_pair_set(argv[1]);
  const auto moved = argc > 6 ? pair_sets::read_perturbations(argv[6], pairs) : std::vector<Pose>{};
  const auto data = io::open_dataset(argv[2], argv[3]);
  std::vector<Row> all;
  std::map<int, std::vector<Row>> by_session;
  for (std::size_t i = 0; i < pairs.size(); i += every) {
    const auto& key = pairs[i].key;
    const Pose P = moved.empty() ? Pose::Identity() : moved[i];
    Row row = measured(transformed(data->load(key.session, key.source), P), data->load(key.session, key.target),
                       pairs[i].T_target_source * P.inverse(), options);
    all.push_back(row);
    by_session[key.session].push_back(row);
  }
  std::printf("%-24s %5s %9s %7s | right %% of mutual: median p25 p5 | >= 5 %% right | recall %%\n",
              options.descriptor.c_str(), "pairs", "keypoints", "mutual");
  for (const auto& [session, rows] : by_session) {
    print("session " + std::to_string(session), rows);
  }
  print("all", all);
  print_times(all);
  return 0;
}

}  // namespace
}  // namespace loopmark::benchmarks

int main(int argc, char** argv) {
  try {
    return loopmark::benchmarks::run(argc, argv);
  } catch (const loopmark::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
