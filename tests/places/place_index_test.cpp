// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/places/place_index.hpp"

#include <gtest/gtest.h>

#include "loopmark/core/parallel.hpp"
#include "synthetic_descriptors.hpp"

namespace loopmark::places {
namespace {

using namespace testing;

TEST(PlaceIndex, FindsTheNearestOfAFewExactly) {
  const std::vector<PlaceDescriptor> drive = drive_descriptors(500, 1);
  PlaceIndex index;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    index.add(1000 + i, drive[i]);
  }
  const PlaceDescriptor query = seen_again(drive[123], 2);
  const std::vector<PlaceMatch> matches = index.query(query, 5);
  ASSERT_EQ(matches.size(), 5U);
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    all.emplace_back(distance(query, drive[i]), 1000 + i);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(matches[n].id, all[n].second);
    EXPECT_NEAR(matches[n].distance, all[n].first, 1e-5);
  }
}

TEST(PlaceIndex, LeavesOutWhatIsNotAccepted) {
  const std::vector<PlaceDescriptor> drive = drive_descriptors(100, 3);
  PlaceIndex index;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    index.add(i, drive[i]);
  }
  EXPECT_EQ(index.query(drive[90], 1)[0].id, 90U);
  const auto old_enough = [](std::size_t id) { return id < 50; };
  for (const PlaceMatch& match : index.query(drive[90], 20, old_enough)) {
    EXPECT_LT(match.id, 50U);
  }
  EXPECT_EQ(index.query(drive[90], 200, old_enough).size(), 50U);
}

TEST(PlaceIndex, OfManyPlacesAgreesWithComparingAll) {
  const std::vector<PlaceDescriptor> drive = drive_descriptors(20000, 4);
  PlaceIndex index;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    index.add(i, drive[i]);
  }
  int found = 0;
  constexpr int kQueries = 200;
  for (int q = 0; q < kQueries; ++q) {
    const PlaceDescriptor query =
        seen_again(drive[static_cast<std::size_t>(97 * q)], 100 + static_cast<std::uint64_t>(q));
    found += index.query(query, 1)[0].id == index.query_exactly(query, 1)[0].id ? 1 : 0;
  }
  EXPECT_GE(found, kQueries * 97 / 100);
}

TEST(PlaceIndex, AnswersTheSameAtAnyNumberOfThreads) {
  const std::vector<PlaceDescriptor> drive = drive_descriptors(6000, 5);
  const auto run = [&](std::size_t threads) {
    set_thread_count(threads);
    PlaceIndex index;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      index.add(i, drive[i]);
    }
    std::vector<std::size_t> ids;
    for (const PlaceMatch& match : index.query(seen_again(drive[77], 6), 50)) {
      ids.push_back(match.id);
    }
    return ids;
  };
  const std::vector<std::size_t> one = run(1);
  EXPECT_EQ(run(2), one);
  set_thread_count(0);
}

TEST(PlaceIndex, KnowsNothingAtFirstAndRefusesOtherSizes) {
  PlaceIndex index;
  EXPECT_TRUE(index.query(PlaceDescriptor{{1.0F, 0.0F}}, 3).empty());
  index.add(0, PlaceDescriptor{{1.0F, 0.0F}});
  EXPECT_THROW(index.add(1, PlaceDescriptor{{1.0F}}), std::invalid_argument);
  EXPECT_THROW(index.query(PlaceDescriptor{{1.0F}}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::places
