// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Runs whose records say what cannot be, each with right checksums: every one is refused with its file and line.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>
#include <limits>

#include "loopmark/core/error.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/multi_session/session_set.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::size_t kFar = 100'000'000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two drives of three scans, the first and third of each a keyframe; a loop and a decision.
multi_session::SessionSet sound_set() {
  multi_session::SessionSet set;
  for (std::size_t i = 0; i < 6; ++i) {
    map_store::ScanRecord scan;
    scan.scan = i;
    scan.stamp_s = 0.1 * static_cast<double>(i);
    scan.segment = i / 3;
    scan.T_segment_lidar = pose_from_yaw(0.1, {static_cast<double>(i), 0.0, 0.0});
    if (i % 3 != 1) {
      scan.keyframe = set.keyframe_files.size();
      set.keyframe_files.emplace_back("k");
    }
    set.scans.push_back(scan);
  }
  set.drives = {{"a", "1", "logs/a", 0, 3}, {"b", "2", "logs/b", 3, 3}};
  map_store::LoopRecord loop;
  loop.source = 3;
  loop.target = 1;
  loop.origin = "place";
  loop.answered = true;
  loop.p_correct = 0.9;
  set.loops = {loop};
  set.decisions = {{2, 0, map_store::LoopOverride::kForce}};
  return set;
}

struct Lie {
  const char* name;
  const char* where;  ///< file and line that the message names
  std::function<void(multi_session::SessionSet&)> tell;
};

const std::vector<Lie>& lies() {
  static const std::vector<Lie> all = {
      {"KeyframeFar", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].keyframe = kFar; }},
      {"KeyframeJustBeyond", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].keyframe = 4; }},
      {"KeyframeTwice", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].keyframe = 1; }},
      {"KeyframeOfDamagedScan", "scans.rec:line 3",
       [](multi_session::SessionSet& s) { s.scans[2].state = map_store::ScanState::kDamaged; }},
      {"ScanFar", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].scan = kFar; }},
      {"SegmentFar", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].segment = kFar; }},
      {"SegmentBack", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].segment = 0; }},
      {"StateUnknown", "scans.rec:line 2",
       [](multi_session::SessionSet& s) { s.scans[1].state = static_cast<map_store::ScanState>(kFar); }},
      {"TrackingUnknown", "scans.rec:line 2",
       [](multi_session::SessionSet& s) { s.scans[1].tracking = static_cast<odometry::Tracking>(3); }},
      {"StampNaN", "scans.rec:line 6", [](multi_session::SessionSet& s) { s.scans[5].stamp_s = kNaN; }},
      {"PoseNaN", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].T_segment_lidar.matrix().setConstant(kNaN); }},
      {"PoseInfinite", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].T_segment_lidar.matrix()(0, 3) = kInfinity; }},
      {"PoseFar", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].T_segment_lidar.matrix()(0, 3) = 0x1p40; }},
      {"PoseSkewed", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].T_segment_lidar.matrix()(0, 0) = 2.0; }},
      {"PoseMirrored", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].T_segment_lidar.linear().col(2) *= -1.0; }},
      {"VelocityNaN", "scans.rec:line 1", [](multi_session::SessionSet& s) { s.scans[0].velocity[3] = kNaN; }},
      {"ShareBeyondOne", "scans.rec:line 1", [](multi_session::SessionSet& s) { s.scans[0].inlier_share = 1.5; }},
      {"CovarianceNaN", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].covariance.setConstant(kNaN); }},
      {"CovarianceNegative", "scans.rec:line 6",
       [](multi_session::SessionSet& s) { s.scans[5].covariance(2, 2) = -1.0; }},
      {"LoopSourceFar", "loops.rec:line 1", [](multi_session::SessionSet& s) { s.loops[0].source = kFar; }},
      {"LoopTargetFar", "loops.rec:line 1", [](multi_session::SessionSet& s) { s.loops[0].target = kFar; }},
      {"LoopToItself", "loops.rec:line 1", [](multi_session::SessionSet& s) { s.loops[0].target = 3; }},
      {"LoopToWhatIsNotThere", "loops.rec:line 1", [](multi_session::SessionSet& s) { s.loops[0].source = 4; }},
      {"LoopNaN", "loops.rec:line 1",
       [](multi_session::SessionSet& s) { s.loops[0].T_target_source.matrix().setConstant(kNaN); }},
      {"LoopSurerThanSure", "loops.rec:line 1", [](multi_session::SessionSet& s) { s.loops[0].p_correct = 1.1; }},
      {"LoopCovarianceNaN", "loops.rec:line 1",
       [](multi_session::SessionSet& s) { s.loops[0].covariance(0, 0) = kNaN; }},
      {"DecisionFar", "decisions.rec:line 1", [](multi_session::SessionSet& s) { s.decisions[0].source = kFar; }},
      {"DecisionMinusOne", "decisions.rec:line 1",
       [](multi_session::SessionSet& s) {
         s.decisions[0] = {~0UL, ~0UL, map_store::LoopOverride::kVeto};
       }},
      {"DriveStartsFar", "sessions.rec:line 1", [](multi_session::SessionSet& s) { s.drives[0].first_scan = kFar; }},
      {"DriveIsLong", "sessions.rec:line 2", [](multi_session::SessionSet& s) { s.drives[1].scans = kFar; }},
      {"DriveLengthWraps", "sessions.rec:line 2", [](multi_session::SessionSet& s) { s.drives[1].scans = ~0UL - 1; }},
      {"DriveIsEmpty", "sessions.rec:line 2", [](multi_session::SessionSet& s) { s.drives[1].scans = 0; }},
      {"DriveSharesASegment", "sessions.rec:line 2",
       [](multi_session::SessionSet& s) {
         s.drives[0].scans = 2;
         s.drives[1] = {"b", "2", "logs/b", 2, 4};
       }},
      {"DriveNameIsAPath", "sessions.rec:line 1",
       [](multi_session::SessionSet& s) { s.drives[0].name = "../../evil"; }},
      {"DriveNameTwice", "sessions.rec:line 2", [](multi_session::SessionSet& s) { s.drives[1].name = "a"; }},
      {"ScansOfNoDrive", "sessions.rec:line 2", [](multi_session::SessionSet& s) { s.drives.pop_back(); }},
  };
  return all;
}

class HostileRun : public ::testing::TestWithParam<Lie> {
 protected:
  HostileRun()
      : path_(fs::path(::testing::TempDir()) / ("loopmark_hostile_run_" + std::to_string(::getpid()))),
        run_((fs::remove_all(path_.string() + ".partial"), map_store::RunFolder::create(path_))) {}
  ~HostileRun() override { fs::remove_all(run_.path()); }

  fs::path path_;
  map_store::RunFolder run_;
};

TEST_P(HostileRun, IsRefusedWithFileAndLine) {
  multi_session::SessionSet set = sound_set();
  multi_session::write_records(set, run_);
  ASSERT_NO_THROW(multi_session::read_session_set(run_));
  GetParam().tell(set);
  multi_session::write_records(set, run_);
  EXPECT_THAT([&] { multi_session::read_session_set(run_); },
              ThrowsMessage<InputError>(AllOf(HasSubstr(GetParam().where), HasSubstr("copy it again"))));
}

INSTANTIATE_TEST_SUITE_P(Lies, HostileRun, ::testing::ValuesIn(lies()), [](const auto& lie) { return lie.param.name; });

TEST_F(HostileRun, APipeInPlaceOfRecordsIsNotWaitedFor) {
  write_records(sound_set(), run_);
  fs::remove(run_.loop_records());
  ASSERT_EQ(::mkfifo(run_.loop_records().c_str(), 0600), 0);
  EXPECT_THAT([&] { map_store::read_run_records(run_); },
              ThrowsMessage<InputError>(HasSubstr("loops.rec: cannot read")));
}

TEST_F(HostileRun, ALineThatIsNoRecordIsNamed) {
  multi_session::write_records(sound_set(), run_);
  storage::RecordWriter(run_.loop_records()).append("1 0 place 1 0x1p-1 no pose");
  EXPECT_THAT([&] { map_store::read_run_records(run_); }, ThrowsMessage<InputError>(HasSubstr("loops.rec:line 2")));
}

TEST_F(HostileRun, EvidenceWithoutEndIsRefused) {
  const multi_session::SessionSet set = sound_set();
  multi_session::write_records(set, run_);
  std::string line = to_line(set.loops[0]);
  const std::size_t count = line.rfind(" 0 ");
  line.replace(count, 3, " 18446744073709551615 a 0x1p+0");
  storage::RecordWriter(run_.loop_records()).append(line);
  EXPECT_THAT([&] { map_store::read_run_records(run_); }, ThrowsMessage<InputError>(HasSubstr("loops.rec:line 2")));
}

}  // namespace
}  // namespace loopmark
