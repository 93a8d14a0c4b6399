// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/loop_closer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "known_run.hpp"

namespace loopmark::mapping {
namespace {

using namespace testing_support;

constexpr std::size_t kFirst = 20;   // keyframes of the first segment, 3 m apart along x
constexpr std::size_t kSecond = 12;  // and of the second, which drives the same road in a frame of its own

class LoopCloserTest : public ::testing::Test {
 protected:
  LoopCloserTest() : run_("loop_closer") {
    for (std::size_t k = 0; k < kFirst; ++k) {
      run_.add(0, pose_from_yaw(0.0, {3.0 * static_cast<double>(k), 0.0, 0.0}), Pose::Identity(), 1);
    }
    for (std::size_t k = 0; k < kSecond; ++k) {
      run_.add(1, pose_from_yaw(0.0, {3.0 * static_cast<double>(k + 4), 0.5, 0.0}), pose_from_yaw(2.0, {500, 100, 0}),
               1);
    }
    registrar_.align_answer = [this](std::size_t source, std::size_t target, bool submaps) {
      return (submaps ? submaps_answer_ : scans_answer_) ? sure_answer(run_.true_motion(source, target)) : no_answer();
    };
  }

  std::vector<map_store::LoopRecord> closed(std::vector<map_store::LoopRecord> loops, std::size_t& kept,
                                            LoopScope scope = {}) const {
    kept = 0;
    const LoopCloser closer(run_.folder(), {}, {}, registrar_, std::move(scope));
    closer.close(run_.scans(), loops, 0, [&](const map_store::LoopRecord&) { ++kept; }, {});
    return loops;
  }
  SolvedMap solved(const std::vector<map_store::LoopRecord>& loops) const {
    return solve_map(run_.scans(), loops, {}, {});
  }

  KnownRun run_;
  ToldRegistrar registrar_;
  bool scans_answer_ = false;
  bool submaps_answer_ = true;
};

std::vector<std::string> lines(const std::vector<map_store::LoopRecord>& loops) {
  std::vector<std::string> result;
  for (const map_store::LoopRecord& loop : loops) {
    result.push_back(to_line(loop));
  }
  return result;
}

std::ptrdiff_t from(const std::vector<map_store::LoopRecord>& loops, const std::string& origin) {
  return std::count_if(loops.begin(), loops.end(),
                       [&](const map_store::LoopRecord& loop) { return loop.origin == origin; });
}

TEST_F(LoopCloserTest, SubmapsJoinSegmentsThatScansDoNot) {
  std::size_t kept = 0;
  const std::vector<map_store::LoopRecord> loops = closed({}, kept);
  EXPECT_EQ(kept, loops.size());
  EXPECT_GT(from(loops, "place"), 0);
  EXPECT_EQ(from(loops, "neighbour"), 6);
  EXPECT_GE(from(loops, kSubmapOrigin), 2);
  const SolvedMap map = solved(loops);
  EXPECT_EQ(map.components, 1U);
  for (std::size_t k = 0; k < kFirst + kSecond; ++k) {
    EXPECT_LT((map.T_map_keyframe[k].translation() - run_.truth(k).translation()).norm(), 0.01) << k;
  }
}

TEST_F(LoopCloserTest, NoSubmapsWhereScansJoinEverything) {
  scans_answer_ = true;
  std::size_t kept = 0;
  EXPECT_EQ(from(closed({}, kept), kSubmapOrigin), 0);
}

TEST_F(LoopCloserTest, EndsWhereNothingJoinsAndForcesNothing) {
  submaps_answer_ = false;
  std::size_t kept = 0;
  const std::vector<map_store::LoopRecord> loops = closed({}, kept);
  EXPECT_LT(kept, 80U);
  EXPECT_EQ(solved(loops).components, 2U);
}

TEST_F(LoopCloserTest, TriesNoPairTwice) {
  submaps_answer_ = false;
  std::size_t kept = 0;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const map_store::LoopRecord& loop : closed({}, kept)) {
    EXPECT_GT(loop.source, loop.target);
    pairs.emplace_back(loop.source, loop.target);
  }
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

/// Wherever a run was interrupted, it ends with the same loops, and tries none again.
TEST_F(LoopCloserTest, GoesOnWhereItWasInterrupted) {
  std::size_t kept = 0;
  const std::vector<map_store::LoopRecord> whole = closed({}, kept);
  for (const std::size_t done : {std::size_t{0}, std::size_t{1}, whole.size() / 2, whole.size() - 1, whole.size()}) {
    const std::vector<map_store::LoopRecord> first(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(done));
    EXPECT_EQ(lines(closed(first, kept)), lines(whole)) << done;
    EXPECT_EQ(kept, whole.size() - done);
  }
}

TEST_F(LoopCloserTest, KeepsToItsScope) {
  scans_answer_ = true;
  std::size_t kept = 0;
  const auto even = [](std::size_t a, std::size_t b) { return std::max(a, b) % 2 == 0; };
  const std::vector<map_store::LoopRecord> loops = closed({}, kept, {false, even});
  ASSERT_FALSE(loops.empty());
  for (const map_store::LoopRecord& loop : loops) {
    EXPECT_EQ(loop.origin, "place");
    EXPECT_GE(loop.source, kFirst);
    EXPECT_LT(loop.target, kFirst);
    EXPECT_EQ(loop.source % 2, 0U);
  }
}

}  // namespace
}  // namespace loopmark::mapping
