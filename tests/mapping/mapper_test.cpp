// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/mapper.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"
#include "support/box_world.hpp"

namespace loopmark::mapping {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kScans = 9;

/// A drive at 10 m/s along a street from the first scan on; it steers all the time.
class MapperTest : public testing::Test {
 protected:
  ~MapperTest() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  Scan scan(std::size_t i) const {
    return {i, 0.1 * static_cast<double>(i), testing_support::sweep(world_, pose(i), velocity_, 0.01, i)};
  }
  Pose pose(std::size_t i) const {
    return pose_from_yaw(-0.05, {0.0, 0.0, 1.8}) * exp_se3(0.1 * static_cast<double>(i) * velocity_);
  }
  Mapper mapper_on(const map_store::RunFolder& folder) const {
    return {folder, {}, nullptr, odometry::Compensation::kRawGivenTimes, {}};
  }
  fs::path new_folder(const std::string& name) const {
    fs::create_directories(root_);
    return root_ / name;
  }

  /// All that a map is made from: what was written of scans and keyframes.
  std::string written(const map_store::RunFolder& folder, std::size_t keyframes) const {
    std::string bytes = storage::read_file(folder.scan_records());
    for (std::size_t k = 0; k < keyframes; ++k) {
      bytes += storage::read_file(folder.keyframe(k, "pcd")) + storage::read_file(folder.keyframe(k, "place"));
    }
    return bytes;
  }

  testing_support::BoxWorld world_ = testing_support::street(120.0, 5);
  Vector6d velocity_ = (Vector6d() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.3).finished();
  fs::path root_ = fs::path(testing::TempDir()) / ("loopmark_mapper_" + std::to_string(::getpid()));
};

TEST_F(MapperTest, TheFirstKeyframeOfASegmentIsNotBentByTheMotion) {
  const map_store::RunFolder folder = map_store::RunFolder::create(new_folder("first"));
  Mapper mapper = mapper_on(folder);
  for (std::size_t i = 0; i < 3; ++i) {
    mapper.add(scan(i));
  }
  std::vector<double> off;  // along the beam, from what a sensor that stands still would see
  for (const Eigen::Vector3f& point : io::read_point_file(folder.keyframe(0, "pcd")).cloud.points) {
    const Eigen::Vector3d ray = pose(0).linear() * point.cast<double>().normalized();
    off.push_back(std::abs(world_.range(pose(0).translation(), ray) - static_cast<double>(point.norm())));
  }
  ASSERT_GT(off.size(), 500U);
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() * 3 / 4], 0.1);  // bent, it is 0.2 m
  EXPECT_NEAR(mapper.scans().front().velocity[0], 10.0, 0.5);
}

TEST_F(MapperTest, GoesOnFromAnySavedStateAsIfNeverInterrupted) {
  const map_store::RunFolder whole = map_store::RunFolder::create(new_folder("whole"));
  std::size_t keyframes = 0;
  {
    Mapper mapper = mapper_on(whole);
    for (std::size_t i = 0; i < kScans; ++i) {
      mapper.add(scan(i));
    }
    mapper.end_log();
    keyframes = mapper.keyframes().size();
  }
  const std::string expected = written(whole, keyframes);
  for (std::size_t stop = 1; stop < kScans; ++stop) {
    const map_store::RunFolder folder = map_store::RunFolder::create(new_folder("stop" + std::to_string(stop)));
    {
      Mapper mapper = mapper_on(folder);
      for (std::size_t i = 0; i < stop; ++i) {
        mapper.add(scan(i));
      }
      mapper.checkpoint();
    }
    Mapper mapper = mapper_on(folder);
    ASSERT_EQ(mapper.scans().size(), stop);
    for (std::size_t i = stop; i < kScans; ++i) {
      mapper.add(scan(i));
    }
    mapper.end_log();
    EXPECT_TRUE(written(folder, keyframes) == expected) << "stopped after " << stop;
  }
}

/// A run that was interrupted at scan 6 and has a saved state there, and the one before it at scan 3.
class PowerCut : public MapperTest {
 protected:
  PowerCut()
      : whole_(map_store::RunFolder::create(new_folder("whole"))),
        cut_(map_store::RunFolder::create(new_folder("cut"))) {
    feed_all(whole_, kScans);
    expected_ = written(whole_, keyframes_);
    Mapper mapper = mapper_on(cut_);
    for (std::size_t i = 0; i < 6; ++i) {
      mapper.add(scan(i));
      if (i == 2 || i == 5) {
        mapper.checkpoint();
      }
    }
  }
  ~PowerCut() override { set_log_sink({}); }

  void feed_all(const map_store::RunFolder& folder, std::size_t count) {
    Mapper mapper = mapper_on(folder);
    for (std::size_t i = mapper.scans().size(); i < count; ++i) {
      mapper.add(scan(i));
    }
    mapper.end_log();
    keyframes_ = mapper.keyframes().size();
  }

  /// The scan that a mapper on the cut run goes on with, and what it says; then it must come to the bytes of the other.
  std::size_t goes_on_from() {
    set_log_sink([this](Severity, const std::string& message) { said_ = said_.empty() ? message : said_; });
    std::size_t from = 0;
    {
      const Mapper mapper = mapper_on(cut_);
      from = mapper.scans().size();
    }
    feed_all(cut_, kScans);
    EXPECT_TRUE(written(cut_, keyframes_) == expected_);
    return from;
  }

  fs::path state() const { return cut_ / "records/odometry.state"; }

  map_store::RunFolder whole_;
  map_store::RunFolder cut_;
  std::size_t keyframes_ = 0;
  std::string expected_;
  std::string said_;
};

TEST_F(PowerCut, WithAllThereItGoesOnWithoutAWord) {
  EXPECT_EQ(goes_on_from(), 6U);
  EXPECT_EQ(said_, "");
}

TEST_F(PowerCut, ALostTailOfTheRecordsGoesBackToTheStateBefore) {
  const std::string records = storage::read_file(cut_.scan_records());
  storage::write_file_atomically(cut_.scan_records(), std::string_view(records).substr(0, records.size() - 10));
  EXPECT_EQ(goes_on_from(), 3U);
  EXPECT_THAT(said_, testing::HasSubstr("not all of them are there"));
}

TEST_F(PowerCut, LostRecordsGoBackToTheBeginning) {
  fs::remove(cut_.scan_records());
  EXPECT_EQ(goes_on_from(), 0U);
  EXPECT_THAT(said_, testing::HasSubstr("going on from scan 0"));
}

TEST_F(PowerCut, ADamagedRecordGoesBackBehindIt) {
  std::string records = storage::read_file(cut_.scan_records());
  records[records.find('\n') + 20] ^= 1;
  storage::write_file_atomically(cut_.scan_records(), records);
  EXPECT_EQ(goes_on_from(), 0U);
}

TEST_F(PowerCut, AnotherRecordWithARightChecksumIsNotTakenForTheOneThatWasCounted) {
  std::vector<std::string> lines = storage::read_records(cut_.scan_records()).lines;
  fs::remove(cut_.scan_records());
  lines[1] = lines[2];
  storage::RecordWriter writer(cut_.scan_records());
  for (const std::string& line : lines) {
    writer.append(line);
  }
  EXPECT_EQ(goes_on_from(), 0U);
}

TEST_F(PowerCut, ADamagedCutOrMissingStateGoesBackToTheOneBefore) {
  const std::string good = storage::read_file(state());
  for (const std::size_t size : {good.size() / 2, std::size_t{0}}) {
    storage::write_file_atomically(state(), std::string_view(good).substr(0, size));
    const Mapper mapper = mapper_on(cut_);
    EXPECT_EQ(mapper.scans().size(), 3U) << size;
  }
  fs::remove(state());
  EXPECT_EQ(goes_on_from(), 3U);
}

TEST_F(PowerCut, WithoutAnyStateItBeginsAnew) {
  storage::write_file_atomically(state(), "nonsense");
  storage::write_file_atomically(state().string() + ".before", "");
  EXPECT_EQ(goes_on_from(), 0U);
  EXPECT_THAT(said_, testing::HasSubstr("no saved state"));
}

TEST_F(PowerCut, AnEmptyKeyframeGoesBackBehindIt) {
  storage::write_file_atomically(cut_.keyframe(0, "place"), "");
  EXPECT_EQ(goes_on_from(), 0U);
  EXPECT_THAT(said_, testing::HasSubstr("000000.place"));
}

}  // namespace
}  // namespace loopmark::mapping
