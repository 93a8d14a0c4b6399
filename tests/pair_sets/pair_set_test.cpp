// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/pair_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"

namespace loopmark::pair_sets {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string without_header(const std::string& content) { return content.substr(content.find('\n')); }

struct PublishedSet {
  const char* file;
  std::size_t rows;
};

class PublishedSets : public testing::TestWithParam<PublishedSet> {};

TEST_P(PublishedSets, AreReadAndWrittenUnchanged) {
  const fs::path file = fs::path(LOOPMARK_SHARED_DIR) / "balanced_sets" / GetParam().file;
  if (!fs::exists(file)) {
    GTEST_SKIP() << "the published sets are not here";
  }
  const auto pairs = read_pair_set(file);
  EXPECT_EQ(pairs.size(), GetParam().rows);
  const TemporaryFolder folder;
  write_pair_set(folder / "again.txt", pairs);
  EXPECT_EQ(without_header(storage::read_file(folder / "again.txt")), without_header(storage::read_file(file)));
}

INSTANTIATE_TEST_SUITE_P(
    All, PublishedSets,
    testing::Values(PublishedSet{"ApolloSouthbay/test.txt", 7008}, PublishedSet{"NuScenes_boston/test.txt", 2592},
                    PublishedSet{"NuScenes_singapore/test.txt", 2592}, PublishedSet{"KITTI_10m/test.txt", 555},
                    PublishedSet{"ApolloSouthbay/validation.txt", 288}, PublishedSet{"KITTI_10m/validation.txt", 180}));

TEST(PublishedMotions, AreWrittenUnchanged) {
  const fs::path file = fs::path(LOOPMARK_SHARED_DIR) / "balanced_sets/NuScenes_boston/test.coarse_motions.txt";
  if (!fs::exists(file)) {
    GTEST_SKIP() << "the published sets are not here";
  }
  const TemporaryFolder folder;
  write_motions(folder / "again.txt", read_motions(file));
  EXPECT_EQ(without_header(storage::read_file(folder / "again.txt")), without_header(storage::read_file(file)));
}

TEST(PairSet, KeepsPairsOfTwoDrives) {
  auto pairs = test::random_pairs(5, 3);
  pairs[2].key.target_session = 7;
  const TemporaryFolder folder;
  write_pair_set(folder / "set.txt", pairs);
  const auto again = read_pair_set(folder / "set.txt");
  ASSERT_EQ(again.size(), 5U);
  EXPECT_EQ(again[2].key.target_session, 7);
  EXPECT_EQ(again[1].key, pairs[1].key);
}

/// A set of three rows whose middle one was changed.
class DamagedSet : public testing::Test {
 protected:
  void SetUp() override {
    write_pair_set(folder_ / "set.txt", test::random_pairs(3, 1));
    content_ = storage::read_file(folder_ / "set.txt");
  }
  std::string message_after(const std::string& content) {
    std::ofstream(folder_ / "set.txt") << content;
    try {
      read_pair_set(folder_ / "set.txt");
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::string line(std::size_t number) const {
    std::size_t at = 0;
    for (std::size_t i = 1; i < number; ++i) {
      at = content_.find('\n', at) + 1;
    }
    return content_.substr(at, content_.find('\n', at) - at);
  }
  std::string with_line(std::size_t number, const std::string& text) const {
    const std::string old = line(number);
    std::string content = content_;
    return content.replace(content.find(old), old.size(), text);
  }

  TemporaryFolder folder_;
  std::string content_;
};

TEST_F(DamagedSet, RowsOfAnotherLengthAreNamed) {
  const std::string row = line(3);
  EXPECT_THAT(message_after(with_line(3, row.substr(0, row.rfind(' ')))),
              testing::AllOf(HasSubstr("line 3"), HasSubstr("26 columns")));
}

TEST_F(DamagedSet, TextThatIsNoNumberIsNamed) {
  std::string row = line(2);
  row.replace(row.rfind(' ') + 1, 3, "abc");
  EXPECT_THAT(message_after(with_line(2, row)), testing::AllOf(HasSubstr("line 2"), HasSubstr("column 27")));
}

TEST_F(DamagedSet, MotionsThatAreNotRigidAreRefused) {
  std::string row = line(3);
  const std::size_t at = test::column_start(row, 3);
  row.replace(at, row.find(' ', at) - at, "1.7");
  EXPECT_THAT(message_after(with_line(3, row)), testing::AllOf(HasSubstr("line 3"), HasSubstr("rigid")));
}

TEST_F(DamagedSet, ColumnsThatContradictTheMatrixAreRefused) {
  std::string row = line(3);
  const std::size_t at = test::column_start(row, 24);
  row.replace(at, row.find(' ', at) - at, "170.0");
  EXPECT_THAT(message_after(with_line(3, row)), HasSubstr("contradicts"));
}

TEST_F(DamagedSet, PairsThatStandThereTwiceAreRefused) {
  EXPECT_THAT(message_after(content_ + line(2) + "\n"), testing::AllOf(HasSubstr("line 5"), HasSubstr("line 2")));
}

TEST_F(DamagedSet, AnEmptyFileIsRefused) { EXPECT_THAT(message_after("header\n"), HasSubstr("no pairs")); }

TEST(Motions, OfAnotherSetAreRefused) {
  const auto pairs = test::random_pairs(4, 1);
  std::vector<PairMotion> motions;
  for (const auto& pair : pairs) {
    motions.push_back({pair.key, pair.T_target_source});
  }
  EXPECT_EQ(motions_of_pairs(pairs, motions, "m.txt").size(), 4U);
  motions.back().key.source += 1000;
  EXPECT_THROW(motions_of_pairs(pairs, motions, "m.txt"), InputError);
  motions.pop_back();
  EXPECT_THROW(motions_of_pairs(pairs, motions, "m.txt"), InputError);
}

TEST(Negatives, ComeBackAsWritten) {
  const TemporaryFolder folder;
  const std::vector<PairKey> negatives = {{2, 60, 6, 2}, {0, 1, 3, 5}};
  write_negatives(folder / "n.txt", negatives);
  EXPECT_EQ(read_negatives(folder / "n.txt"), negatives);
}

}  // namespace
}  // namespace loopmark::pair_sets
