// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/multi_session/inter_session_loops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapping/known_run.hpp"

namespace loopmark::multi_session {
namespace {

using namespace testing_support;
using ::testing::HasSubstr;

constexpr std::size_t kEach = 40;  // keyframes of a drive, 3 m apart

/// Two drives along one road, and a third along another that looks like it in one place.
class JoinDrives : public ::testing::Test {
 protected:
  JoinDrives() : run_("inter_session_loops") {
    registrar_.align_answer = [this](std::size_t source, std::size_t target, bool) { return answer(source, target); };
    registrar_.verify_answer = [this](std::size_t source, std::size_t target, const Pose& claimed) {
      return foreign(source) == foreign(target)     ? sure_answer(run_.true_motion(source, target))
             : in_alias(source) && in_alias(target) ? sure_answer(claimed)
                                                    : no_answer();
    };
  }

  /// The first `alias` keyframes of the third drive look as the other road does there.
  void drive(std::size_t alias) {
    alias_ = alias;
    for (std::size_t d = 0; d < 3; ++d) {
      const Pose T_segment_world = pose_from_yaw(0.7 * static_cast<double>(d), {100.0 * static_cast<double>(d), 0, 0});
      for (std::size_t k = 0; k < kEach; ++k) {
        run_.add(d, pose_from_yaw(0.0, {3.0 * static_cast<double>(k), static_cast<double>(d), 0.0}), T_segment_world,
                 d == 2 && k >= alias ? 9 : 1);
      }
      set_.drives.push_back({"drive" + std::to_string(d), std::to_string(d), "", d * kEach, kEach});
    }
    set_.scans = run_.scans();
    set_.keyframe_files.resize(3 * kEach);
  }

  static bool foreign(std::size_t k) { return k >= 2 * kEach; }
  bool in_alias(std::size_t k) const { return k % kEach < alias_; }

  /// True between the first two drives; to the third, a motion that all its loops agree on but only where it looks
  /// alike.
  registration::RegistrationResult answer(std::size_t source, std::size_t target) const {
    if (foreign(source) == foreign(target) || (in_alias(source) && in_alias(target))) {
      return sure_answer(run_.true_motion(source, target));
    }
    return no_answer();
  }

  JoinedDrives joined() const { return join_sessions(set_, run_.folder(), {}, {}, registrar_); }

  std::size_t alias_ = 0;
  KnownRun run_;
  SessionSet set_;
  ToldRegistrar registrar_;
};

TEST_F(JoinDrives, LeavesOutADriveThatNoLoopJoins) {
  drive(0);
  const JoinedDrives result = joined();
  EXPECT_TRUE(result.verdicts[0].belongs);
  EXPECT_TRUE(result.verdicts[1].belongs);
  EXPECT_EQ(result.verdicts[1].in_map, kEach);
  EXPECT_FALSE(result.verdicts[2].belongs);
  EXPECT_THAT(result.verdicts[2].reason,
              HasSubstr("pairs of places tried with the others, the best has P(correct) 0.10"));
  ASSERT_EQ(result.inter_session_loops.size(), 3U);
  EXPECT_GE(result.inter_session_loops[0].accepted, 2U);
  EXPECT_GE(result.inter_session_loops[0].checked, 4U);
  EXPECT_EQ(result.inter_session_loops[0].agree, result.inter_session_loops[0].checked);
}

/// Eight places in a row that look alike give loops that agree; the rest of the road says no.
TEST_F(JoinDrives, ContradictionsElsewhereOutweighLoopsThatAgree) {
  drive(8);
  const JoinedDrives result = joined();
  EXPECT_TRUE(result.verdicts[0].belongs);
  EXPECT_TRUE(result.verdicts[1].belongs);
  EXPECT_FALSE(result.verdicts[2].belongs);
  EXPECT_THAT(result.verdicts[2].reason, HasSubstr("look the same"));
  std::size_t withdrawn = 0;
  for (const map_store::LoopRecord& loop : result.set.loops) {
    EXPECT_FALSE(loop.answered && foreign(loop.source) != foreign(loop.target));
    withdrawn += loop.reason == "the drives contradict each other elsewhere" ? 1 : 0;
  }
  EXPECT_GE(withdrawn, 2U);
}

TEST_F(JoinDrives, TheOrderOfTheDrivesDoesNotMatterToWhoBelongs) {
  drive(0);
  SessionSet turned;
  for (const std::size_t d : {2U, 0U, 1U}) {
    std::vector<bool> only(3, false);
    only[d] = true;
    append(selected(set_, only), turned);
  }
  // The files stay where they were: link them by their new numbers.
  KnownRun linked("drive_joints_turned");
  for (std::size_t k = 0; k < turned.scans.size(); ++k) {
    const std::size_t drive = (k / kEach + 2) % 3;
    linked.add(k / kEach, run_.truth(drive * kEach + k % kEach), Pose::Identity(), drive == 2 ? 9 : 1);
  }
  ToldRegistrar registrar;
  registrar.align_answer = [&](std::size_t source, std::size_t target, bool) {
    return (source < kEach) == (target < kEach) ? sure_answer(linked.true_motion(source, target)) : no_answer();
  };
  registrar.verify_answer = [&](std::size_t source, std::size_t target, const Pose&) {
    return registrar.align_answer(source, target, false);
  };
  const JoinedDrives result = join_sessions(turned, linked.folder(), {}, {}, registrar);
  EXPECT_FALSE(result.verdicts[0].belongs);
  EXPECT_TRUE(result.verdicts[1].belongs);
  EXPECT_TRUE(result.verdicts[2].belongs);
}

}  // namespace
}  // namespace loopmark::multi_session
