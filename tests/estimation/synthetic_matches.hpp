// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Matches with a known motion: inliers with noise, outliers between random places of the same scene.
#pragma once

#include "loopmark/core/random.hpp"
#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::testing_support {

struct SyntheticMatches {
  estimation::PointPairs pairs;
  Pose T_target_source = Pose::Identity();
  std::vector<bool> inlier;
};

/// `share` of `count` matches are right to `sigma_m` an axis. With `sorted`, quality has some value: right matches
/// stand more often in front.
inline SyntheticMatches synthetic_matches(std::size_t count, double share, double sigma_m, std::uint64_t seed,
                                          bool sorted = true) {
  Rng rng(task_seed(seed, {count}));
  SyntheticMatches world;
  world.T_target_source = pose_from_yaw(rng.uniform(-M_PI, M_PI), {rng.uniform(-30, 30), rng.uniform(-30, 30), 0.3});
  const auto place = [&] {
    return Eigen::Vector3d(rng.uniform(-40, 40), rng.uniform(-40, 40), rng.uniform(-1.5, 6.0));
  };
  const auto right = static_cast<std::size_t>(share * static_cast<double>(count) + 0.5);
  std::vector<std::pair<double, bool>> order;
  for (std::size_t i = 0; i < count; ++i) {
    const bool inlier = i < right;
    order.emplace_back(rng.uniform() * (sorted && inlier ? 0.5 : 1.0), inlier);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [key, inlier] : order) {
    const Eigen::Vector3d p = place();
    const Eigen::Vector3d noise(rng.normal(), rng.normal(), rng.normal());
    const Eigen::Vector3d q = inlier ? Eigen::Vector3d(world.T_target_source * p + sigma_m * noise)
                                     : Eigen::Vector3d(world.T_target_source * place());
    world.pairs.source.push_back(p.cast<float>());
    world.pairs.target.push_back(q.cast<float>());
    world.inlier.push_back(inlier);
  }
  return world;
}

}  // namespace loopmark::testing_support
