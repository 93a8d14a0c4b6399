// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/descriptor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::features {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <class Number>
std::string bytes_of(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

/// A .npy file as numpy.save writes it.
std::string npy(const std::string& type, const std::string& shape, const std::string& data, bool fortran = false) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  header += std::string(64 - (header.size() + 11) % 64, ' ') + "\n";
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xFFU);
  out += static_cast<char>(header.size() >> 8U);
  return out + header + data;
}

std::string number(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k) {
    out += static_cast<char>(value >> (8 * k) & 0xFFU);
  }
  return out;
}

std::string deflated(const std::string& content) {
  std::string out(compressBound(content.size()) + 64, '\0');
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// A ZIP archive as numpy.savez (stored) or numpy.savez_compressed writes it.
std::string zip(const std::vector<std::pair<std::string, std::string>>& members, bool compress) {
  std::string out;
  std::string directory;
  for (const auto& [name, content] : members) {
    const std::string packed = compress ? deflated(content) : content;
    const std::string common = number(compress ? 8 : 0, 2) + number(0, 4) + number(storage::crc32(content), 4) +
                               number(packed.size(), 4) + number(content.size(), 4) + number(name.size(), 2);
    directory += "PK\1\2" + number(20, 2) + number(20, 2) + number(0, 2) + common + number(0, 2) + number(0, 2) +
                 number(0, 2) + number(0, 2) + number(0, 4) + number(out.size(), 4) + name;
    out += "PK\3\4" + number(20, 2) + number(0, 2) + common + number(0, 2) + name + packed;
  }
  const std::size_t start = out.size();
  return out + directory + "PK\5\6" + number(0, 4) + number(members.size(), 2) + number(members.size(), 2) +
         number(directory.size(), 4) + number(start, 4) + number(0, 2);
}

std::filesystem::path write(const std::string& name, const std::string& content) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

const std::string kPoints = npy("<f8", "(2, 3)", bytes_of<double>({1, 2, 3, 4, 5, 6}));
const std::string kFeatures = npy("<f4", "(2, 4)", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}));
const std::string kRaw = npy("<f8", "(3, 3)", bytes_of<double>({9, 9, 9, 9, 9, 9, 9, 9, 9}));

const search::DescriptorMatrix& floats(const DescriptorFile& file) {
  return std::get<search::DescriptorMatrix>(file.descriptors);
}

TEST(DescriptorFile, ReadsWhatFcgfExports) {
  for (const bool compress : {false, true}) {
    const auto path =
        write("fcgf.npz", zip({{"points.npy", kRaw}, {"xyz.npy", kPoints}, {"feature.npy", kFeatures}}, compress));
    const DescriptorFile file = read_descriptors(path);
    ASSERT_EQ(file.points.size(), 2U);
    EXPECT_EQ(file.points[1], Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(floats(file).row(1), Eigen::RowVector4f(5, 6, 7, 8));
  }
}

TEST(DescriptorFile, TakesThePointsThatFitTheDescriptors) {
  const auto path =
      write("d3.npz", zip({{"xyz.npy", kRaw}, {"points.npy", kPoints}, {"features.npy", kFeatures}}, false));
  EXPECT_EQ(read_descriptors(path).points[0], Eigen::Vector3f(1, 2, 3));
}

TEST(DescriptorFile, ReadsTwoNpyFilesInEitherOrder) {
  const std::string fortran = npy("<f4", "(2, 4)", bytes_of<float>({1, 5, 2, 6, 3, 7, 4, 8}), true);
  const DescriptorFile file = read_descriptors(write("f.npy", fortran), write("p.npy", kPoints));
  EXPECT_EQ(floats(file).row(0), Eigen::RowVector4f(1, 2, 3, 4));
}

TEST(DescriptorFile, ReadsOtherTypesOfNumbers) {
  const auto points = write("p.npy", kPoints);
  const std::string half = bytes_of<std::uint16_t>({0x3C00, 0x4000, 0xC000, 0x3800});  // 1, 2, -2, 0.5
  EXPECT_EQ(floats(read_descriptors(write("h.npy", npy("<f2", "(2, 2)", half)), points)).row(1),
            Eigen::RowVector2f(-2, 0.5F));
  EXPECT_EQ(floats(read_descriptors(write("u.npy", npy("|u1", "(2, 1)", "\x07\xFF")), points))(1, 0), 255.0F);
  const DescriptorFile whole = read_descriptors(write("i.npy", npy("|i1", "(2, 1)", "\x07\x81")), points);
  EXPECT_EQ(std::get<search::QuantizedDescriptors>(whole.descriptors)(1, 0), -127);
}

void expect_complaint(const std::string& content, const std::string& part) {
  const auto path = write("bad.npz", content);
  EXPECT_THAT([&] { read_descriptors(path); }, ThrowsMessage<InputError>(HasSubstr("bad.npz")));
  EXPECT_THAT([&] { read_descriptors(path); }, ThrowsMessage<InputError>(HasSubstr(part)));
}

/// The archive with the place of a member's data in the directory moved to that of the first.
std::string sharing_one_stream(std::size_t members, const std::string& content) {
  const std::string first = zip({{"a00.npy", content}}, true);
  const std::size_t directory = first.find("PK\1\2");
  const std::size_t end = first.find("PK\5\6");
  std::string entries;
  for (std::size_t i = 0; i < members; ++i) {
    std::string entry = first.substr(directory, end - directory);
    entry[47] = static_cast<char>('0' + i / 10);
    entry[48] = static_cast<char>('0' + i % 10);
    entries += entry;
  }
  return first.substr(0, directory) + entries + "PK\5\6" + number(0, 4) + number(members, 2) + number(members, 2) +
         number(entries.size(), 4) + number(directory, 4) + number(0, 2);
}

TEST(DescriptorFile, MembersThatShareTheirBytesAreRefused) {
  expect_complaint(sharing_one_stream(60, std::string(1U << 20U, '\0')), "overlap");
}

TEST(DescriptorFile, AnArchiveThatUnpacksToTooMuchIsRefused) {
  std::string claims = zip({{"features.npy", std::string(1U << 20U, '\0')}}, true);
  claims.replace(claims.find("PK\1\2") + 24, 4, number(std::uint64_t{1} << 30U, 4));
  expect_complaint(claims, "more than 512 MiB");
}

TEST(DescriptorFile, SaysWhatIsWrong) {
  const auto with = [](const std::string& features) {
    return zip({{"xyz.npy", kPoints}, {"features.npy", features}}, false);
  };
  expect_complaint("", "not a .npz archive");
  expect_complaint("hello", "not a .npz archive");
  expect_complaint(zip({{"xyz.npy", kPoints}}, false), "no array of descriptors");
  expect_complaint(zip({{"features.npy", kFeatures}}, false), "no array of points");
  expect_complaint(zip({{"xyz.npy", kRaw}, {"features.npy", kFeatures}}, false), "2 descriptors for 3 points");
  expect_complaint(with("not numpy at all"), "not a NumPy array");
  expect_complaint(with(npy("<f4", "(2, 4)", "short")), "cut off");
  expect_complaint(with(npy("<f4", "(8,)", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}))), "two dimensions");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_complaint(with(npy("<f4", "(2, 2)", bytes_of<float>({1, 2, 3, nan}))),
                   "row 1 holds a number that is not finite");
  expect_complaint(with(npy("|i1", "(2, 1)", "\x07\x80")), "-128");
  expect_complaint(with(npy(">f4", "(2, 1)", "12345678")), "big-endian");
  expect_complaint(with(npy("<c8", "(2, 1)", "1234567812345678")), "not known");
  expect_complaint(with(npy("<f4", "(999999999999, 999999)", "")), "cut off");
}

TEST(DescriptorFile, NoDamageGoesUnnoticedOrBreaksTheReader) {
  const std::string good = zip({{"xyz.npy", kPoints}, {"features.npy", kFeatures}}, true);
  for (std::size_t i = 0; i < good.size(); i += i < good.size() / 2 ? 5 : 1) {
    for (const std::string& bad :
         {good.substr(0, i), std::string(good).replace(i, 1, 1, static_cast<char>(good[i] ^ 0x55))}) {
      try {
        const DescriptorFile file = read_descriptors(write("fuzz.npz", bad));
        // Only fields that the reader does not need may have changed.
        EXPECT_EQ(floats(file).row(1), Eigen::RowVector4f(5, 6, 7, 8)) << "byte " << i;
      } catch (const InputError&) {
      }
    }
  }
}

TEST(DescriptorFile, SaysWhenThereIsNoFile) { EXPECT_THROW(read_descriptors("/no/such/file.npz"), InputError); }

}  // namespace
}  // namespace loopmark::features
