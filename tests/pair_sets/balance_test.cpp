// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/pair_sets/balanced_selection.hpp"
#include "loopmark/pair_sets/candidate_pool.hpp"
#include "loopmark/pair_sets/hard_negatives.hpp"
#include "loopmark/pair_sets/reference_refinement.hpp"
#include "loopmark/pair_sets/set_statistics.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"
#include "pair_sets/small_drives.hpp"

namespace loopmark::pair_sets {
namespace {

const std::vector<Drive>& drives() {
  static const std::vector<Drive> two = {test::circle_drive(3, 260, 1, 0.0), test::circle_drive(8, 130, 1, 2.0, -1.0)};
  return two;
}

const Drive& drive_of(int session) { return session == 3 ? drives()[0] : drives()[1]; }

/// The paper's overlap, written down once more as simply as possible.
std::vector<Eigen::Vector3d> brute_centroids(const std::vector<Eigen::Vector3f>& points) {
  std::map<std::tuple<int, int, int>, std::pair<Eigen::Vector3d, int>> cells;
  for (const auto& p : points) {
    auto& [sum, count] = cells
                             .try_emplace({static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                                           static_cast<int>(std::floor(p.z()))},
                                          Eigen::Vector3d::Zero(), 0)
                             .first->second;
    sum += p.cast<double>();
    ++count;
  }
  std::vector<Eigen::Vector3d> centroids;
  for (const auto& [cell, sum] : cells) {
    centroids.push_back(sum.first / sum.second);
  }
  return centroids;
}

std::pair<double, double> brute_overlap(const RegistrationPair& pair) {
  const Drive& from = drive_of(pair.key.session);
  const Drive& to = drive_of(pair.key.target_session);
  const auto place = [](const Drive& drive, int frame) {
    return static_cast<std::size_t>(frame - drive.frames.front());
  };
  const auto a = brute_centroids(transformed(from.load(place(from, pair.key.source)), pair.T_target_source).points);
  const auto b = brute_centroids(to.load(place(to, pair.key.target)).points);
  double near = 0.0;
  for (const auto& p : a) {
    near += std::any_of(b.begin(), b.end(), [&](const auto& q) { return (p - q).squaredNorm() < 2.0; }) ? 1.0 : 0.0;
  }
  const double share = near / static_cast<double>(a.size());
  return {share, std::min(share, near / static_cast<double>(b.size()))};
}

const std::vector<RegistrationPair>& pool() {
  static const auto candidates = make_candidate_pool(drives(), 60, {});
  return candidates;
}

TEST(CandidatePool, OverlapsHoldByBruteForce) {
  ASSERT_GT(pool().size(), 100U);
  for (std::size_t i = 0; i < pool().size(); i += 5) {
    const RegistrationPair& pair = pool()[i];
    const auto [share, symmetric] = brute_overlap(pair);
    EXPECT_NEAR(pair.overlap, share, 0.01);
    EXPECT_NEAR(pair.overlap_symmetric, symmetric, 0.01);
    EXPECT_GE(pair.overlap_symmetric, 0.2);
  }
}

TEST(CandidatePool, TargetsFollowTheirSourcesWithinTheGap) {
  BalanceOptions options;
  options.max_gap_s = 1.05;
  for (const RegistrationPair& pair : make_candidate_pool(drives(), 20, options)) {
    EXPECT_GT(pair.key.target, pair.key.source);
    EXPECT_LE(pair.key.target - pair.key.source, 10);
    const Drive& drive = drive_of(pair.key.session);
    const Pose truth = drive.T_world_cloud[static_cast<std::size_t>(pair.key.target - 1)].inverse() *
                       drive.T_world_cloud[static_cast<std::size_t>(pair.key.source - 1)];
    EXPECT_LT((truth.matrix() - pair.T_target_source.matrix()).norm(), 1e-12);
  }
}

TEST(CandidatePool, SpacingFollowsTheNumberAskedFor) {
  EXPECT_EQ(source_spacing(drives(), 10, {}), 390U / 40U);
  EXPECT_EQ(source_spacing(drives(), 1000, {}), 1U);
}

bool same_pairs(const std::vector<RegistrationPair>& a, const std::vector<RegistrationPair>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.key == y.key && x.T_target_source.matrix() == y.T_target_source.matrix() && x.overlap == y.overlap;
  });
}

TEST(CandidatePool, IsTheSameForAnyThreadsAndGoesOnWhereItWasCut) {
  const test::TemporaryFolder folder;
  const auto records = folder / "pool.records";
  set_thread_count(1);
  const auto one = make_candidate_pool(drives(), 20, {}, records);
  set_thread_count(0);
  EXPECT_TRUE(same_pairs(one, make_candidate_pool(drives(), 20, {})));
  std::filesystem::resize_file(records, std::filesystem::file_size(records) * 2 / 3);
  PoolCost cost;
  EXPECT_TRUE(same_pairs(one, make_candidate_pool(drives(), 20, {}, records, &cost)));
  EXPECT_GT(cost.overlaps, 0U);
  make_candidate_pool(drives(), 20, {}, records, &cost);
  EXPECT_EQ(cost.overlaps, 0U);
  BalanceOptions other;
  other.seed = 1;
  EXPECT_THROW(make_candidate_pool(drives(), 20, other, records), InputError);
}

/// The selection written down once more without the grid.
std::vector<PairKey> brute_selection(const std::vector<RegistrationPair>& pool, std::size_t count,
                                     const BalanceOptions& o) {
  Rng rng(task_seed(o.seed, {0x73656c65U, pool.size()}));
  std::vector<bool> here(pool.size(), true);
  std::map<int, double> candidates;
  std::map<int, double> chosen;
  for (const auto& pair : pool) {
    candidates[pair.key.session] += 1.0;
  }
  std::vector<PairKey> picked;
  while (picked.size() < count) {
    Vector6d low = Vector6d::Constant(1e300);
    Vector6d high = -low;
    for (std::size_t i = 0; i < pool.size(); ++i) {
      if (here[i]) {
        low = low.cwiseMin(pool[i].motion);
        high = high.cwiseMax(pool[i].motion);
      }
    }
    Vector6d place;
    for (double& value : place) {
      value = rng.uniform();
    }
    std::tuple<double, int, double, std::size_t> best{1e300, 0, 0.0, pool.size()};
    for (std::size_t i = 0; i < pool.size(); ++i) {
      double squared = 0.0;
      for (int axis = 0; axis < 6; ++axis) {
        const double range = high[axis] - low[axis];
        if (range > 1e-12) {
          squared += std::pow((pool[i].motion[axis] - low[axis]) / range - place[axis], 2);
        }
      }
      const int session = pool[i].key.session;
      if (here[i] && squared <= o.radius * o.radius) {
        best = std::min(best, {chosen[session] / candidates[session], session, squared, i});
      }
    }
    if (const std::size_t index = std::get<3>(best); index < pool.size()) {
      here[index] = false;
      chosen[pool[index].key.session] += 1.0;
      picked.push_back(pool[index].key);
    }
  }
  std::sort(picked.begin(), picked.end());
  return picked;
}

TEST(Selection, IsThePapersByBruteForce) {
  BalanceOptions options;
  options.seed = 5;
  SelectionReport report;
  const auto set = select_balanced(pool(), 40, options, &report);
  std::vector<PairKey> keys;
  for (const auto& pair : set) {
    keys.push_back(pair.key);
  }
  EXPECT_EQ(keys, brute_selection(pool(), 40, options));
  EXPECT_EQ(report.chosen.at(3) + report.chosen.at(8), 40U);
}

TEST(Selection, IsMoreEvenThanChanceAndFairToDrives) {
  Rng rng(1);
  std::vector<RegistrationPair> many;
  for (int i = 0; i < 4000; ++i) {  // mostly straight on, as drives are; two in three from the first drive
    Pose pose = pose_from_yaw(0.4 * std::pow(rng.normal(), 3) * 0.1,
                              {-60.0 * rng.uniform() * rng.uniform(), 2.0 * rng.normal(), 0.0});
    many.push_back(make_pair({i % 3 == 0 ? 2 : 1, i, i + 1, i % 3 == 0 ? 2 : 1}, pose, 0.5, 0.5));
  }
  SelectionReport report;
  const auto set = select_balanced(many, 600, {}, &report);
  ASSERT_EQ(set.size(), 600U);
  const std::vector<RegistrationPair> random(many.begin(), many.begin() + 600);
  for (const int axis : {0, 1, 5}) {
    EXPECT_LT(motion_unevenness(set, many, axis), 0.8 * motion_unevenness(random, many, axis)) << axis;
  }
  const double share1 = static_cast<double>(report.chosen.at(1)) / static_cast<double>(report.candidates.at(1));
  const double share2 = static_cast<double>(report.chosen.at(2)) / static_cast<double>(report.candidates.at(2));
  EXPECT_NEAR(share1, share2, 0.05);
}

/// The mean unevenness of many random choices from the candidates.
double unevenness_by_chance(const std::vector<RegistrationPair>& candidates, std::size_t count, int axis) {
  constexpr int kDraws = 50;
  double mean = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Rng rng(static_cast<std::uint64_t>(draw));
    auto some = candidates;
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(some[i], some[i + rng.below(static_cast<std::uint32_t>(some.size() - i))]);
    }
    some.resize(count);
    mean += motion_unevenness(some, candidates, axis) / kDraws;
  }
  return mean;
}

TEST(Selection, OnDrivesThroughStreetsIsMoreEvenThanChanceAndFair) {
  const std::vector<Drive> streets = {test::block_drive(3, 320, 0), test::block_drive(8, 160, 0)};
  const auto candidates = make_candidate_pool(streets, 100, {});
  SelectionReport report;
  const auto set = select_balanced(candidates, 80, {}, &report);
  // Along x there is nothing to even out here: targets are drawn uniformly up to the farthest, which is as far
  // everywhere.
  for (const int axis : {1, 5}) {
    EXPECT_LT(motion_unevenness(set, candidates, axis), 0.9 * unevenness_by_chance(candidates, 80, axis)) << axis;
  }
  const auto share = [&](int session) {
    return static_cast<double>(report.chosen.at(session)) / static_cast<double>(report.candidates.at(session));
  };
  EXPECT_NEAR(share(3), share(8), 0.1);
}

TEST(Selection, OfMoreThanThereIsTakesAll) {
  const auto all = test::random_pairs(30, 2);
  BalanceOptions wide;
  wide.radius = 0.8;
  EXPECT_EQ(select_balanced(all, 100, wide).size(), 30U);
}

TEST(Revisits, AreLaterOrInOtherDrives) {
  BalanceOptions options;
  options.max_gap_s = 5.0;
  options.revisit_distance_m = 20.0;
  const auto revisits = make_revisit_pool(drives(), 60, true, options);
  std::set<bool> kinds;
  for (const RegistrationPair& pair : revisits) {
    const bool other_drive = pair.key.session != pair.key.target_session;
    kinds.insert(other_drive);
    EXPECT_TRUE(other_drive || std::abs(pair.key.target - pair.key.source) > 50);
    EXPECT_GE(brute_overlap(pair).second, 0.19);
  }
  EXPECT_EQ(kinds.size(), 2U);
  for (const RegistrationPair& pair : make_revisit_pool(drives(), 60, false, options)) {
    EXPECT_EQ(pair.key.session, pair.key.target_session);
  }
}

TEST(HardNegatives, ShareNothing) {
  BalanceOptions options;
  options.negative_distance_m = 60.0;
  const auto negatives = find_hard_negatives(drives(), 12, true, options);
  EXPECT_EQ(negatives.size(), 12U);
  for (const PairKey& key : negatives) {
    const Pose T = drive_of(key.target_session).T_world_cloud[static_cast<std::size_t>(key.target - 1)].inverse() *
                   drive_of(key.session).T_world_cloud[static_cast<std::size_t>(key.source - 1)];
    EXPECT_EQ(brute_overlap(make_pair(key, T, 0.0, 0.0)).first, 0.0);
  }
}

TEST(RingDescriptor, DoesNotDependOnTheHeading) {
  const auto points = drives()[0].load(5).points;
  const auto turned = transformed({points, {}, {}, {}}, pose_from_yaw(6.0 * std::numbers::pi / 180.0 * 5.0)).points;
  const auto a = ring_descriptor(points);
  const auto b = ring_descriptor(turned);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i], b[i], 0.35) << i;
  }
}

TEST(ReferenceRefinement, MendsHeightsOnly) {
  std::vector<RegistrationPair> pairs(pool().begin(), pool().begin() + 6);
  std::vector<Pose> truth;
  for (RegistrationPair& pair : pairs) {
    truth.push_back(pair.T_target_source);
    Pose off = pair.T_target_source;
    off.translation().z() += 0.25;
    pair = make_pair(pair.key, off, pair.overlap, pair.overlap_symmetric);
  }
  const RefinementReport report = refine_references(pairs, drives(), ReferenceRefinement::kHeight);
  EXPECT_EQ(report.refined + report.kept, 6U);
  EXPECT_GE(report.refined, 5U);
  EXPECT_NEAR(report.median_shift_m, 0.25, 0.06);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].T_target_source.translation().head<2>(), truth[i].translation().head<2>());
  }
}

TEST(Drives, WithoutPosesAreRefused) {
  Drive drive = test::circle_drive(1, 5, 0, 0.0);
  EXPECT_NO_THROW(check(drive));
  drive.T_world_cloud.pop_back();
  EXPECT_THROW(check(drive), InputError);
}

}  // namespace
}  // namespace loopmark::pair_sets
