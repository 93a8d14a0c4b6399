// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Scan files and logs that promise what they do not hold: each is refused, none is believed.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>

#include "io/io_fixtures.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::io {
namespace {

namespace fs = std::filesystem;
using testing::bytes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using testing::TemporaryFolder;

struct PcdPromise {
  std::string name, size, count, points;
};

/// A header of the fields x y z w with the given entries, and 60 bytes.
std::string pcd(const PcdPromise& promise, const std::string& data, const std::string& body = std::string(60, '1')) {
  return "VERSION 0.7\nFIELDS x y z w\nSIZE " + promise.size + "\nTYPE F F F F\nCOUNT " + promise.count +
         "\nWIDTH 1\nHEIGHT 1\nPOINTS " + promise.points + "\nDATA " + data + "\n" + body;
}

/// Promises whose product is 0 or small in 64 bits; a sound reader sees that 60 bytes do not hold them.
const std::vector<PcdPromise> kWrapping = {
    {"count", "4 4 4 4", "1 1 1 4294967293", "4294967296"},  // 16 bytes x 2^30 x 2^32
    {"size", "4 4 4 4294967284", "1 1 1 1", "4294967296"},
    {"both", "4 4 4 4294967296", "1 1 1 4294967296", "4294967296"},
    {"points", "4 4 4 4", "1 1 1 65536", "4294967296"},
};

TEST(HostilePcd, SizesWhoseProductWrapsAreRefused) {
  const TemporaryFolder folder;
  const std::string lzf = bytes_of(std::uint32_t{8}) + bytes_of(std::uint32_t{0}) + std::string(8, '\0');
  for (const PcdPromise& promise : kWrapping) {
    for (const char* data : {"ascii", "binary", "binary_compressed"}) {
      const fs::path file = folder.write("a.pcd", pcd(promise, data, *data == 'b' && data[6] == '_' ? lzf : "1 2 3 4"));
      EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(file); }), HasSubstr("a.pcd"))
          << promise.name << " " << data;
    }
  }
}

TEST(HostilePcd, WidthTimesHeightThatWrapsIsRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder.write(
      "a.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4294967296\nHEIGHT 4294967296\nDATA ascii\n1 2 3");
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(file); }), HasSubstr("WIDTH and HEIGHT"));
}

TEST(HostilePcd, CompressedSizesBeyondWhatLzfCanDoAreRefusedBeforeMemoryIsTaken) {
  const TemporaryFolder folder;
  const std::string body = bytes_of(std::uint32_t{8}) + bytes_of(std::uint32_t{16U << 26U}) + std::string(8, '\0');
  const fs::path file =
      folder.write("a.pcd", pcd({"", "4 4 4 4", "1 1 1 1", std::to_string(1U << 26U)}, "binary_compressed", body));
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(file); }), HasSubstr("does not fit"));
}

TEST(HostilePcd, AsciiThatPromisesMoreNumbersThanBytesIsTruncated) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.pcd", pcd({"", "4 4 4 4", "1 1 1 1", "3"}, "ascii", "1 2 3 4\n5 6 7 8\n"));
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(file); }), HasSubstr("3 points are promised, 2 are there"));
  const fs::path whole = folder.write("b.pcd", pcd({"", "4 4 4 4", "1 1 1 1", "2"}, "ascii", "1 2 3 4 5 6 7 8"));
  EXPECT_EQ(read_point_file(whole).cloud.size(), 2U);
}

TEST(HostilePoints, RingsThatAreNoneAreLeftOutAndThePointsKept) {
  const TemporaryFolder folder;
  const auto with_ring = [&](float ring) {
    std::string bytes;
    for (int i = 1; i <= 3; ++i) {
      for (const float value : {static_cast<float>(i), 2.0F, 3.0F, 0.5F, i == 2 ? ring : 7.0F}) {
        bytes += bytes_of(value);
      }
    }
    LogOptions options;
    options.bin_columns = 5;
    return read_point_file(folder.write("a.bin", bytes), options).cloud;
  };
  EXPECT_EQ(with_ring(65535.0F).ring, (std::vector<std::uint16_t>{7, 65535, 7}));
  for (const float ring :
       {std::numeric_limits<float>::quiet_NaN(), 65536.0F, -1.0F, 1e30F, std::numeric_limits<float>::infinity()}) {
    EXPECT_TRUE(with_ring(ring).ring.empty()) << ring;
    EXPECT_EQ(with_ring(ring).size(), 3U);
  }
}

TEST(HostilePoints, AFileLargerThanAnyScanIsRefusedByName) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.bin", "");
  fs::resize_file(file, std::uintmax_t{1} << 40U);  // sparse: takes no room
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(file); }), HasSubstr("larger than 1 GiB"));
}

TEST(HostilePoints, PipesAndDevicesAreNotWaitedFor) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "a.bin";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(pipe); }), HasSubstr("not a file"));
  fs::create_symlink("/dev/zero", folder / "b.bin");
  EXPECT_THAT(message_of<DamagedScan>([&] { read_point_file(folder / "b.bin"); }), HasSubstr("not a file"));
}

TEST(HostileLog, ALineOfTimesWithoutAWordIsNoTime) {
  const TemporaryFolder folder;
  for (int i = 0; i < 2; ++i) {
    write_bin(folder / ("00000" + std::to_string(i) + ".bin"), random_cloud(60));
  }
  folder.write("times.txt", "0.1\n,\n");
  EXPECT_THAT(message_of<InputError>([&] { open_log(folder.path()); }), HasSubstr("times.txt:2: ',' is no time"));
}

}  // namespace
}  // namespace loopmark::io
