// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/multi_session/session_set.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "loopmark/core/error.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::multi_session {
namespace {

namespace fs = std::filesystem;

/// A drive of `count` scans, every second one a keyframe, in two segments; one loop and one decision within.
SessionSet drive(const std::string& name, std::size_t count, double x) {
  SessionSet set;
  set.drives = {{name, "identity of " + name, "logs/" + name, 0, count}};
  for (std::size_t i = 0; i < count; ++i) {
    map_store::ScanRecord scan;
    scan.scan = i;
    scan.segment = i < count / 2 ? 0 : 1;
    scan.T_segment_lidar = pose_from_yaw(0.0, {x + static_cast<double>(i), 0.0, 0.0});
    if (i % 2 == 0) {
      scan.keyframe = set.keyframe_files.size();
      set.keyframe_files.emplace_back(name + "/" + std::to_string(*scan.keyframe));
    }
    set.scans.push_back(scan);
  }
  map_store::LoopRecord loop;
  loop.source = 2;
  loop.target = 0;
  loop.origin = name;
  set.loops = {loop};
  set.decisions = {{2, 0, map_store::LoopOverride::kVeto}};
  return set;
}

std::vector<std::string> lines(const SessionSet& set) {
  std::vector<std::string> result;
  for (const map_store::ScanRecord& scan : set.scans) {
    result.push_back(to_line(scan));
  }
  for (const map_store::LoopRecord& loop : set.loops) {
    result.push_back(to_line(loop));
  }
  for (const fs::path& file : set.keyframe_files) {
    result.push_back(file.string());
  }
  return result;
}

TEST(SessionSet, NumbersOneDriveBehindTheOther) {
  SessionSet set = drive("a", 6, 0.0);
  append(drive("b", 8, 100.0), set);
  ASSERT_EQ(set.scans.size(), 14U);
  for (std::size_t i = 0; i < set.scans.size(); ++i) {
    EXPECT_EQ(set.scans[i].scan, i);
  }
  EXPECT_EQ(set.drives[1].first_scan, 6U);
  EXPECT_EQ(set.scans[6].segment, 2U);
  EXPECT_EQ(set.scans[13].segment, 3U);
  EXPECT_EQ(set.scans[8].keyframe, std::optional<std::size_t>(4));
  EXPECT_EQ(set.keyframe_files[4], "b/1");
  EXPECT_EQ(set.loops[1].source, 5U);
  EXPECT_EQ(set.loops[1].target, 3U);
  EXPECT_EQ(set.decisions[1].source, 5U);
  EXPECT_EQ(set.session_of_keyframe(), (std::vector<std::size_t>{0, 0, 0, 1, 1, 1, 1}));
  const std::vector<mapping::Keyframe> keyframes = mapping::keyframes_of(set.scans);
  ASSERT_EQ(keyframes.size(), set.keyframe_files.size());
  EXPECT_DOUBLE_EQ(keyframes.back().path_m, 2.0 + 2.0 + 3.0 + 2.0) << "the way between segments is not driven";
}

TEST(SessionSet, LeavingOutADriveIsAsIfItHadNeverBeenThere) {
  SessionSet all = drive("a", 6, 0.0);
  append(drive("b", 8, 100.0), all);
  append(drive("c", 6, 200.0), all);
  map_store::LoopRecord between;
  between.source = 8;
  between.target = 1;
  between.origin = "a to c";
  all.loops.push_back(between);
  between.target = 4;
  all.loops.push_back(between);
  SessionSet expected = drive("a", 6, 0.0);
  append(drive("c", 6, 200.0), expected);
  between.source = 4;
  between.target = 1;
  expected.loops.push_back(between);
  EXPECT_EQ(lines(selected(all, {true, false, true})), lines(expected));
  EXPECT_EQ(selected(all, {true, false, true}).decisions.size(), 2U);
  EXPECT_EQ(lines(selected(all, {true, true, true})), lines(all));
}

TEST(SessionSet, TheSameDriveTwiceIsRefusedAndTheSameNameGetsANumber) {
  SessionSet set = drive("a", 6, 0.0);
  EXPECT_THROW(append(drive("a", 6, 0.0), set), InputError);
  SessionSet other = drive("a", 6, 50.0);
  other.drives[0].identity = "another";
  append(other, set);
  EXPECT_EQ(set.drives[1].name, "a-2");
}

TEST(SessionSet, ComesBackFromItsRecords) {
  const fs::path path = fs::path(::testing::TempDir()) / ("loopmark_drive_set_" + std::to_string(::getpid()));
  fs::remove_all(path);
  map_store::RunFolder run = map_store::RunFolder::create(path);
  SessionSet set = drive("a", 6, 0.0);
  append(drive("b", 8, 100.0), set);
  write_records(set, run);
  storage::write_file_atomically(run / "manifest.json", "{}");
  run.finish();
  const SessionSet back = read_session_set(run);
  ASSERT_EQ(back.drives.size(), 2U);
  EXPECT_EQ(back.drives[1].name, "b");
  EXPECT_EQ(back.drives[1].identity, "identity_of_b") << "words hold no blanks";
  EXPECT_EQ(back.drives[1].log, "logs/b");
  EXPECT_EQ(back.drives[1].first_scan, 6U);
  EXPECT_EQ(back.scans.size(), 14U);
  EXPECT_EQ(back.loops.size(), 2U);
  EXPECT_EQ(back.keyframe_files[6], run.keyframe(6, "pcd").replace_extension());
  fs::remove_all(path);
}

}  // namespace
}  // namespace loopmark::multi_session
