// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/recordings/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>

#include "loopmark/recordings/recording_writer.hpp"
#include "support/temporary_folder.hpp"

namespace loopmark::recordings {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using testing_support::TemporaryFolder;

Channel points_channel(Encoding encoding = Encoding::kCdr) {
  return {"/points", "sensor_msgs/PointCloud2", encoding, "", "uint32 height\n", "1158d486dd51d683ce2f1be655c3c181"};
}
Channel imu_channel(Encoding encoding = Encoding::kCdr) {
  return {"/imu", "sensor_msgs/Imu", encoding, "", "uint32 x\n", "6a62c6daae103f4ff57a132d6f95cec2"};
}

/// Compresses well, but not to nothing; differs from message to message.
std::string content(std::size_t i) {
  std::string text;
  while (text.size() < 50000 + 100 * i) {
    text += std::to_string(i * 7919 + text.size()) + " ";
  }
  return text;
}

/// Some large messages with many small ones between.
void fill(RecordingWriter& writer, Encoding encoding, std::size_t count) {
  const auto points = writer.add_channel(points_channel(encoding));
  const auto imu = writer.add_channel(imu_channel(encoding));
  for (std::size_t i = 0; i < count; ++i) {
    const auto time = static_cast<std::int64_t>(1'600'000'000'000'000'000 + i * 100'000'000);
    writer.write(points, time, content(i));
    for (int k = 0; k < 10; ++k) {
      writer.write(imu, time + k * 1000, "imu " + std::to_string(10 * i + static_cast<std::size_t>(k)));
    }
  }
  writer.finish();
}

struct Seen {
  std::vector<MessageRef> points;
  std::vector<std::string> imu;
};

Seen walk(Recording& recording) {
  Seen seen;
  recording.walk([](const Channel& c) { return c.topic == "/imu" ? kAllBytes : 4; },
                 [&](const MessageRef& m, std::string_view bytes) {
                   if (recording.channels()[m.channel].topic == "/imu") {
                     seen.imu.emplace_back(bytes);
                   } else {
                     EXPECT_EQ(bytes, content(seen.points.size()).substr(0, 4));
                     seen.points.push_back(m);
                   }
                 });
  return seen;
}

void expect_whole(Recording& recording, std::size_t count) {
  const Seen seen = walk(recording);
  EXPECT_THAT(recording.problems(), IsEmpty());
  ASSERT_THAT(seen.points, SizeIs(count));
  ASSERT_THAT(seen.imu, SizeIs(10 * count));
  EXPECT_EQ(seen.imu[17], "imu 17");
  for (const std::size_t i : {count - 1, std::size_t{0}, count / 2}) {
    EXPECT_EQ(recording.read(seen.points[i]), content(i));
    EXPECT_EQ(seen.points[i].time_ns, static_cast<std::int64_t>(1'600'000'000'000'000'000 + i * 100'000'000));
  }
}

class Chunks : public ::testing::TestWithParam<ChunkCompression> {};
INSTANTIATE_TEST_SUITE_P(Recording, Chunks,
                         ::testing::Values(ChunkCompression::kNone, ChunkCompression::kFast,
                                           ChunkCompression::kStrong));

TEST_P(Chunks, McapGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  fill(*create_mcap(folder / "a.mcap", GetParam()), Encoding::kCdr, 120);
  const auto recording = open_mcap(folder / "a.mcap");
  expect_whole(*recording, 120);
  EXPECT_EQ(recording->channels()[0].type, "sensor_msgs/PointCloud2");
  EXPECT_EQ(recording->channels()[0].definition, "uint32 height\n");
}

TEST_P(Chunks, RosbagGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  fill(*create_rosbag(folder / "a.bag", GetParam()), Encoding::kRos1, 60);
  const auto recording = open_rosbag(folder / "a.bag");
  expect_whole(*recording, 60);
  EXPECT_EQ(recording->channels()[1].md5, "6a62c6daae103f4ff57a132d6f95cec2");
}

std::string file_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

/// What is whole is given, the rest is said; never a crash, never a message that is not right.
TEST_P(Chunks, CutOffAnywhereGivesWhatIsWhole) {
  const TemporaryFolder folder;
  fill(*create_mcap(folder / "a.mcap", GetParam()), Encoding::kCdr, 120);
  fill(*create_rosbag(folder / "a.bag", GetParam()), Encoding::kRos1, 60);
  for (const char* name : {"a.mcap", "a.bag"}) {
    const std::string whole = file_bytes(folder / name);
    std::size_t most = 0;
    for (std::size_t k = 1; k < 40; ++k) {
      const fs::path cut = folder / ("cut_" + std::string(name));
      write_bytes(cut, whole.substr(0, k * whole.size() / 40 + k % 7));
      const auto recording = name == std::string("a.mcap") ? open_mcap(cut) : open_rosbag(cut);
      const Seen seen = walk(*recording);
      EXPECT_GE(seen.points.size(), most);
      most = seen.points.size();
      for (std::size_t i = 0; i < seen.points.size(); i += 20) {
        EXPECT_EQ(recording->read(seen.points[i]), content(i));
      }
    }
    EXPECT_GT(most, std::size_t{40});
  }
}

TEST(Recording, CutOffIsSaid) {
  const TemporaryFolder folder;
  fill(*create_mcap(folder / "a.mcap"), Encoding::kCdr, 120);
  write_bytes(folder / "cut.mcap", file_bytes(folder / "a.mcap").substr(0, 1'000'000));
  const auto recording = open_mcap(folder / "cut.mcap");
  walk(*recording);
  ASSERT_THAT(recording->problems(), Not(IsEmpty()));
  EXPECT_THAT(recording->problems().front(), HasSubstr("cut.mcap:byte "));
}

TEST(Recording, DamagedBytesAreFoundByTheChecksum) {
  const TemporaryFolder folder;
  fill(*create_mcap(folder / "a.mcap", ChunkCompression::kFast), Encoding::kCdr, 100);
  std::string bytes = file_bytes(folder / "a.mcap");
  for (std::size_t i = 0; i < 40; ++i) {
    bytes[bytes.size() / 3 + i] ^= 0x55;
  }
  write_bytes(folder / "bad.mcap", bytes);
  const auto recording = open_mcap(folder / "bad.mcap");
  std::size_t messages = 0;
  recording->walk([](const Channel&) { return std::size_t{0}; },
                  [&](const MessageRef&, std::string_view) { ++messages; });
  EXPECT_LT(messages, std::size_t{1101});
  ASSERT_THAT(recording->problems(), Not(IsEmpty()));
  EXPECT_THAT(recording->problems().front(), HasSubstr("damaged chunk"));
}

TEST(Recording, ALengthBeyondTheFileIsSaidAndNotBelieved) {
  const TemporaryFolder folder;
  std::string bytes("\x89MCAP0\r\n", 8);
  bytes += std::string("\x04\xff\xff\xff\xff\xff\xff\xff\x7f", 9) + "abc";
  write_bytes(folder / "a.mcap", bytes);
  const auto recording = open_mcap(folder / "a.mcap");
  EXPECT_THAT(walk(*recording).points, IsEmpty());
  EXPECT_THAT(recording->problems().front(), HasSubstr("cut off"));
}

/// A chunk that promises 100 bytes and holds a hundred million.
TEST(Recording, ABombIsNotUnpacked) {
  const TemporaryFolder folder;
  {
    const auto writer = create_mcap(folder / "bomb.mcap", ChunkCompression::kStrong);
    const auto points = writer->add_channel(points_channel());
    writer->write(points, 1, std::string(100'000'000, 'x'));
    writer->finish();
  }
  std::string bytes = file_bytes(folder / "bomb.mcap");
  EXPECT_LT(bytes.size(), std::size_t{200'000});
  const std::size_t chunk = bytes.find('\x06', 8 + 9 + 16);
  const std::uint64_t promised = 100;
  bytes.replace(chunk + 9 + 16, 8, reinterpret_cast<const char*>(&promised), 8);
  write_bytes(folder / "bomb.mcap", bytes);
  const auto recording = open_mcap(folder / "bomb.mcap");
  EXPECT_THAT(walk(*recording).points, IsEmpty());
  ASSERT_THAT(recording->problems(), Not(IsEmpty()));
  EXPECT_THAT(recording->problems().front(), HasSubstr("more than the promised 100 bytes"));
}

TEST(Recording, OtherFilesAreRefusedByName) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.mcap", "hello");
  write_bytes(folder / "a.bag", "#ROSBAG V1.2\nxxxx");
  EXPECT_THROW(open_mcap(folder / "a.mcap"), InputError);
  EXPECT_THROW(open_rosbag(folder / "a.mcap"), InputError);
  try {
    open_rosbag(folder / "a.bag");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rosbag fix"));
  }
}

TEST(Rosbag2, GivesBackWhatWasWrittenAsFolderAndAsFile) {
  const TemporaryFolder folder;
  fill(*create_rosbag2(folder / "bag"), Encoding::kCdr, 50);
  expect_whole(*open_rosbag2(folder / "bag"), 50);
  expect_whole(*open_rosbag2(folder / "bag/bag_0.db3"), 50);
  fs::remove(folder / "bag/metadata.yaml");
  expect_whole(*open_rosbag2(folder / "bag"), 50);
}

TEST(Rosbag2, AMissingPartIsSaidAndTheOthersAreUsed) {
  const TemporaryFolder folder;
  fill(*create_rosbag2(folder / "bag"), Encoding::kCdr, 5);
  write_bytes(folder / "bag/metadata.yaml",
              "rosbag2_bagfile_information:\n  relative_file_paths:\n    - bag_0.db3\n    - bag_1.db3\n");
  const auto recording = open_rosbag2(folder / "bag");
  EXPECT_THAT(walk(*recording).points, SizeIs(5));
  ASSERT_THAT(recording->problems(), SizeIs(1));
  EXPECT_THAT(recording->problems()[0], HasSubstr("bag_1.db3: a part of the bag is not there"));
}

TEST(Rosbag2, MetadataThatIsNoneIsAnError) {
  const TemporaryFolder folder;
  fill(*create_rosbag2(folder / "bag"), Encoding::kCdr, 2);
  for (const char* text : {"[1, 2", "a: b\n", "rosbag2_bagfile_information: 3\n"}) {
    write_bytes(folder / "bag/metadata.yaml", text);
    EXPECT_THROW(open_rosbag2(folder / "bag"), InputError) << text;
  }
}

TEST(Rosbag2, ADamagedDatabaseGivesWhatIsWhole) {
  const TemporaryFolder folder;
  fill(*create_rosbag2(folder / "bag"), Encoding::kCdr, 50);
  std::string bytes = file_bytes(folder / "bag/bag_0.db3");
  write_bytes(folder / "cut.db3", bytes.substr(0, bytes.size() * 2 / 3));
  const auto cut = open_rosbag2(folder / "cut.db3");
  const Seen seen = walk(*cut);
  EXPECT_LT(seen.points.size(), std::size_t{50});
  EXPECT_THAT(cut->problems(), Not(IsEmpty()));
  write_bytes(folder / "text.db3", std::string("SQLite format 3\0", 16) + std::string(5000, 'x'));
  EXPECT_THROW(open_rosbag2(folder / "text.db3"), InputError);
  write_bytes(folder / "none.db3", "hello");
  EXPECT_THROW(open_rosbag2(folder / "none.db3"), InputError);
}

TEST(Rosbag2, ALockedDatabaseIsSaid) {
  const TemporaryFolder folder;
  fill(*create_rosbag2(folder / "bag"), Encoding::kCdr, 3);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "bag/bag_0.db3").c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  try {
    open_rosbag2(folder / "bag");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another program is writing"));
  }
  sqlite3_close(other);
}

TEST(Writers, NothingIsLeftOfARecordingThatWasNotFinished) {
  const TemporaryFolder folder;
  {
    const auto mcap = create_mcap(folder / "a.mcap");
    const auto bag = create_rosbag2(folder / "bag");
    mcap->write(mcap->add_channel(points_channel()), 1, "x");
    bag->write(bag->add_channel(points_channel()), 1, "x");
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  write_bytes(folder / "b.mcap", "mine");
  EXPECT_THROW(create_mcap(folder / "b.mcap"), InputError);
  EXPECT_EQ(file_bytes(folder / "b.mcap"), "mine");
}

}  // namespace
}  // namespace loopmark::recordings
