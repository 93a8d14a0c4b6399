// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "io/io_fixtures.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/log_formats.hpp"
#include "loopmark/io/recorded_log.hpp"
#include "loopmark/messages/definitions.hpp"
#include "loopmark/messages/types.hpp"
#include "loopmark/messages/wire.hpp"
#include "loopmark/recordings/recording_writer.hpp"
#include "support/shared_data.hpp"

namespace loopmark::io {
namespace {

using messages::Encoding;
using messages::PointCloud2;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using ::testing::SizeIs;
using testing::TemporaryFolder;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

/// How a topic's points are laid out.
struct Layout {
  std::string time_field = "t";
  std::uint8_t time_type = 6;  // uint32
  double time_unit_s = 1e-9;
  bool absolute = false;
  std::uint32_t padding = 0;  // bytes at the end of each row
  std::uint32_t height = 1;
};

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

void put_time(std::string& bytes, std::size_t at, std::uint8_t type, double value) {
  if (type == 6) {
    put(bytes, at, static_cast<std::uint32_t>(value));
  } else if (type == 7) {
    put(bytes, at, static_cast<float>(value));
  } else {
    put(bytes, at, value);
  }
}

/// z before x, ring as uint8 at an odd place, times as the layout says.
std::string cloud_message(recordings::Encoding encoding, const PointCloud& cloud, std::int64_t stamp_ns,
                          const Layout& layout = {}) {
  constexpr std::uint32_t kStep = 29;
  messages::PointCloud2 m;
  m.header.set_stamp_ns(stamp_ns);
  m.header.frame_id = "lidar";
  m.point_fields = {{"z", 0, 7, 1}, {"x", 4, 7, 1}, {"y", 8, 7, 1}, {"intensity", 12, 4, 1}, {"ring", 14, 2, 1}};
  m.point_fields.push_back({layout.time_field, 15, layout.time_type, 1});
  m.height = layout.height;
  m.width = static_cast<std::uint32_t>(cloud.size()) / layout.height;
  m.point_step = kStep;
  m.row_step = m.width * kStep + layout.padding;
  std::string data(std::size_t{m.row_step} * m.height, '\x7f');
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t at = i / m.width * m.row_step + i % m.width * kStep;
    put(data, at, cloud.points[i].z());
    put(data, at + 4, cloud.points[i].x());
    put(data, at + 8, cloud.points[i].y());
    put(data, at + 12, static_cast<std::uint16_t>(cloud.intensity[i]));
    put(data, at + 14, static_cast<std::uint8_t>(cloud.ring[i]));
    const double start = layout.absolute ? 1e-9 * static_cast<double>(stamp_ns) : 0.0;
    put_time(data, at + 15, layout.time_type,
             (start + static_cast<double>(cloud.time_offset_s[i])) / layout.time_unit_s);
  }
  m.data = data;
  return messages::encode(encoding, m);
}

recordings::Channel channel_of(const std::string& topic, const std::string& type, recordings::Encoding encoding) {
  return {topic,
          type,
          encoding,
          "",
          messages::definition_text(type, encoding == recordings::Encoding::kRos1),
          messages::definition_md5(type)};
}

std::unique_ptr<recordings::RecordingWriter> create(const std::string& format, const std::filesystem::path& path) {
  return format == "mcap"      ? recordings::create_mcap(path)
         : format == "rosbag1" ? recordings::create_rosbag(path)
                               : recordings::create_rosbag2(path);
}

/// A drive of `count` scans at 10 Hz, recorded 3 ms after their stamps, with a second smaller cloud topic and an IMU.
void write_drive(const std::string& format, const std::filesystem::path& path, std::size_t count,
                 const Layout& layout = {}) {
  const recordings::Encoding encoding = format == "rosbag1" ? recordings::Encoding::kRos1 : recordings::Encoding::kCdr;
  const auto writer = create(format, path);
  const auto scans = writer->add_channel(channel_of("/lidar/points", "sensor_msgs/PointCloud2", encoding));
  const auto map = writer->add_channel(channel_of("/map_cloud", "sensor_msgs/PointCloud2", encoding));
  const auto imu = writer->add_channel(channel_of("/imu/data", "sensor_msgs/Imu", encoding));
  const auto mount = writer->add_channel(channel_of("/tf_static", "tf2_msgs/TFMessage", encoding));
  messages::TransformMessage transforms;
  transforms.transforms.resize(2);
  transforms.transforms[0].header.frame_id = transforms.transforms[1].header.frame_id = "base";
  transforms.transforms[0].child_frame_id = "lidar";
  transforms.transforms[0].transform.position = {0.0, 0.0, 2.0};
  transforms.transforms[0].transform.orientation_xyzw = {0.0, 0.0, 1.0, 0.0};  // turned about
  transforms.transforms[1].child_frame_id = "imu";
  transforms.transforms[1].transform.position = {1.0, 0.0, 0.5};
  writer->write(mount, kStart_ns, messages::encode(encoding, transforms));
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t stamp = kStart_ns + static_cast<std::int64_t>(i) * 100'000'000;
    messages::Imu sample;
    sample.header.set_stamp_ns(stamp);
    sample.linear_acceleration = {0.0, 0.0, 9.81};
    writer->write(imu, stamp, messages::encode(encoding, sample));
    const std::string bytes = cloud_message(encoding, random_cloud(300 + 2 * i, i + 1), stamp, layout);
    writer->write(scans, stamp + 3'000'000, bytes);
    writer->write(map, stamp + 4'000'000, cloud_message(encoding, random_cloud(3000, i + 1), stamp, layout));
  }
  writer->finish();
}

void expect_cloud(const PointCloud& cloud, const PointCloud& truth) {
  ASSERT_EQ(cloud.size(), truth.size());
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    EXPECT_EQ(cloud.points[i], truth.points[i]);
    EXPECT_EQ(cloud.intensity[i], truth.intensity[i]);
    EXPECT_EQ(cloud.ring[i], truth.ring[i]);
    EXPECT_NEAR(cloud.time_offset_s[i], truth.time_offset_s[i], 2e-6);
  }
}

class Containers : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(RecordingLog, Containers, ::testing::Values("mcap", "rosbag1", "rosbag2"));

TEST_P(Containers, TheDriveComesBack) {
  const TemporaryFolder folder;
  write_drive(GetParam(), folder / "drive", 12);
  const auto log = open_log(folder / "drive");
  EXPECT_EQ(log->info().format, GetParam());
  EXPECT_EQ(as_recorded(*log)->recording().topic, "/lidar/points");
  EXPECT_THAT(as_recorded(*log)->recording().topic_reason, HasSubstr("of 2 with scans"));
  EXPECT_THAT(as_recorded(*log)->recording().topic_content, HasSubstr("'t', nanoseconds from the stamp"));
  ASSERT_EQ(log->size(), 12U);
  for (const std::size_t i : {11U, 0U, 5U}) {
    EXPECT_EQ(log->stamp_s(i), 1e-9 * static_cast<double>(kStart_ns + static_cast<std::int64_t>(i) * 100'000'000));
    expect_cloud(log->read(i).cloud, random_cloud(300 + 2 * i, i + 1));
  }
}

TEST_P(Containers, MotionAndMountingAreToldToo) {
  const TemporaryFolder folder;
  write_drive(GetParam(), folder / "drive", 4);
  const auto log = open_log(folder / "drive");
  std::size_t samples = 0;
  as_recorded(*log)->visit_observations([&](const Observation& observation) {
    ASSERT_TRUE(std::holds_alternative<ImuSample>(observation));
    EXPECT_NEAR(std::get<ImuSample>(observation).linear_acceleration_m_s2.z(), 9.81, 1e-12);
    ++samples;
  });
  EXPECT_EQ(samples, 4U);
  ASSERT_TRUE(as_recorded(*log)->recording().mounts.contains("imu"));
  const Eigen::Vector3d in_lidar =
      as_recorded(*log)->recording().mounts.at("imu").translation();  // base -> lidar is turned by 180 degrees
  EXPECT_NEAR((in_lidar - Eigen::Vector3d(-1.0, 0.0, -1.5)).norm(), 0.0, 1e-12);
}

TEST_P(Containers, AnotherTopicCanBeChosen) {
  const TemporaryFolder folder;
  write_drive(GetParam(), folder / "drive", 3);
  LogOptions options;
  options.sensor_label = "/map_cloud";
  EXPECT_EQ(open_log(folder / "drive", options)->read(0).cloud.size(), 3000U);
  options.sensor_label = "/imu/data";
  EXPECT_THAT(message_of<InputError>([&] { open_log(folder / "drive", options); }),
              HasSubstr("its messages are sensor_msgs/Imu, which are no scans"));
  options.sensor_label = "/nothing";
  EXPECT_THAT(message_of<InputError>([&] { open_log(folder / "drive", options); }),
              HasSubstr("there are: /lidar/points"));
}

/// Each layout of time fields that drivers write ends as the same offsets.
TEST(PointCloud2Times, TheUnitIsFoundFromTheValues) {
  const std::vector<std::pair<Layout, const char*>> layouts = {
      {{"t", 6, 1e-9, false}, "nanoseconds from the stamp"},
      {{"offset_time", 6, 1e-6, false}, "microseconds from the stamp"},
      {{"time", 7, 1.0, false}, "seconds from the stamp"},
      {{"time", 7, 1e-3, false}, "milliseconds from the stamp"},
      {{"timestamp", 8, 1.0, true}, "seconds of a clock"},
      {{"timestamp", 8, 1e-9, true}, "nanoseconds of a clock"},
      {{"timestamp", 8, 1e-6, true}, "microseconds of a clock"},
      {{"t", 6, 1e-9, false, 64, 2}, "nanoseconds from the stamp"},
  };
  std::size_t number = 0;
  for (const auto& [layout, words] : layouts) {
    const TemporaryFolder folder;
    write_drive("mcap", folder / "drive.mcap", 3, layout);
    const auto log = open_log(folder / "drive.mcap");
    EXPECT_THAT(as_recorded(*log)->recording().topic_content, HasSubstr(words)) << number;
    expect_cloud(log->read(1).cloud, random_cloud(302, 2));
    ++number;
  }
}

/// One topic with the given messages.
void write_messages(const std::filesystem::path& path, const std::vector<std::string>& bytes) {
  const auto writer = recordings::create_mcap(path);
  const auto channel =
      writer->add_channel(channel_of("/points", "sensor_msgs/PointCloud2", recordings::Encoding::kCdr));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    writer->write(channel, kStart_ns + static_cast<std::int64_t>(i) * 100'000'000, bytes[i]);
  }
  writer->finish();
}

TEST(PointCloud2Times, PointsWithoutEchoDoNotShiftThem) {
  const TemporaryFolder folder;
  PointCloud cloud = random_cloud(200);
  const PointCloud whole = cloud;
  for (std::size_t i = 0; i < 100; i += 2) {
    cloud.points[i] =
        i % 4 == 0 ? Eigen::Vector3f::Zero() : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  }
  Layout layout{"timestamp", 8, 1.0, true};
  std::string bytes = cloud_message(recordings::Encoding::kCdr, cloud, kStart_ns, layout);
  const std::size_t data = bytes.size() - 1 - 200 * 29;
  for (std::size_t i = 0; i < 100; i += 2) {
    put(bytes, data + i * 29 + 15, 0.0);  // drivers leave the time of what has no echo unset
  }
  write_messages(folder / "a.mcap", {bytes, bytes});
  const ScanReading reading = open_log(folder / "a.mcap")->read_closely(0);
  EXPECT_EQ(reading.dropped.no_return, 25U);
  EXPECT_EQ(reading.dropped.not_finite, 25U);
  ASSERT_EQ(reading.scan.cloud.time_offset_s.size(), 150U);
  EXPECT_NEAR(reading.scan.cloud.time_offset_s.back(), whole.time_offset_s.back(), 2e-6);
  EXPECT_NEAR(reading.scan.cloud.time_offset_s.front(), whole.time_offset_s[1], 2e-6);
}

TEST(RecordingLog, DamagedMessagesAreDamagedScans) {
  const TemporaryFolder folder;
  const std::string good = cloud_message(recordings::Encoding::kCdr, random_cloud(100), kStart_ns);
  std::string big_endian = good;
  big_endian[1] = 0;
  std::string lying = good;
  const std::size_t width = 4 + 8 + 4 + 8 + 4;  // head, stamp, length of frame_id, "lidar" padded, height
  put(lying, width, std::uint32_t{4'000'000'000U});
  write_messages(folder / "a.mcap", {good, good.substr(0, 60), big_endian, lying, good});
  const auto log = open_log(folder / "a.mcap");
  ASSERT_EQ(log->size(), 5U);
  EXPECT_EQ(log->read(0).cloud.size(), 100U);
  EXPECT_EQ(log->read(4).cloud.size(), 100U);
  EXPECT_THAT(message_of<DamagedScan>([&] { log->read(1); }), HasSubstr("a.mcap:/points message 1"));
  EXPECT_THAT(message_of<DamagedScan>([&] { log->read(2); }), HasSubstr("big-endian CDR"));
  EXPECT_THAT(message_of<DamagedScan>([&] { log->read(3); }), HasSubstr("4000000000 x 1 points"));
}

TEST(RecordingLog, NoScansIsAnErrorThatTellsWhatIsThere) {
  const TemporaryFolder folder;
  write_messages(folder / "empty.mcap", {});
  EXPECT_THAT(message_of<InputError>([&] { open_log(folder / "empty.mcap"); }), HasSubstr("no topic with scans"));
  const auto writer = recordings::create_mcap(folder / "imu.mcap");
  writer->write(writer->add_channel(channel_of("/imu", "sensor_msgs/Imu", recordings::Encoding::kCdr)), 1,
                messages::encode(recordings::Encoding::kCdr, messages::Imu{}));
  writer->finish();
  EXPECT_THAT(message_of<InputError>([&] { open_log(folder / "imu.mcap"); }), HasSubstr("/imu (sensor_msgs/Imu, 1)"));
}

TEST(RecordingLog, StampsThatAreNoneAreTakenFromTheRecording) {
  const TemporaryFolder folder;
  const std::string unset = cloud_message(recordings::Encoding::kCdr, random_cloud(100), 0);
  write_messages(folder / "a.mcap", {unset, unset, unset});
  const auto log = open_log(folder / "a.mcap");
  EXPECT_THAT(log->info().stamps_source, HasSubstr("the recording"));
  EXPECT_NEAR(log->stamp_s(2) - log->stamp_s(0), 0.2, 1e-6);
}

TEST(LogFormats, EveryFormatIsToldInTheHelpAndTheGuide) {
  std::ifstream guide(std::string(LOOPMARK_SOURCE_DIR) + "/docs/guide/my-log.md");
  const std::string text{std::istreambuf_iterator<char>(guide), {}};
  ASSERT_FALSE(log_formats().empty());
  for (const DriveLogFormat& format : log_formats()) {
    EXPECT_THAT(log_formats_text(), HasSubstr(format.layout));
    EXPECT_THAT(text, HasSubstr("| " + format.name + " |")) << "docs/guide/my-log.md has no row for it";
  }
}

}  // namespace
}  // namespace loopmark::io
