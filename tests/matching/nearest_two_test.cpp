// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/matching/nearest_two.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::matching {
namespace {

/// Rows near a few centres: many near-equal neighbours, as histograms of flat ground are.
search::DescriptorMatrix clustered(Eigen::Index rows, Eigen::Index columns, double spread, std::uint64_t seed) {
  Rng centres_rng(99);
  search::DescriptorMatrix centres(6, columns);
  for (Eigen::Index k = 0; k < centres.size(); ++k) {
    centres.data()[k] = static_cast<float>(centres_rng.uniform(0.0, 100.0));
  }
  Rng rng(seed);
  search::DescriptorMatrix m(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto centre = static_cast<Eigen::Index>(rng.below(6));
    for (Eigen::Index c = 0; c < columns; ++c) {
      m(r, c) = centres(centre, c) + static_cast<float>(spread * rng.normal());
    }
  }
  return m;
}

double squared(const search::DescriptorMatrix& a, Eigen::Index i, const search::DescriptorMatrix& b, std::uint32_t j) {
  return (a.row(i).cast<double>() - b.row(static_cast<Eigen::Index>(j)).cast<double>()).squaredNorm();
}

void expect_nearest(const search::DescriptorMatrix& queries, const search::DescriptorMatrix& in,
                    const std::vector<NearestTwo>& found) {
  ASSERT_EQ(found.size(), static_cast<std::size_t>(queries.rows()));
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    double first = std::numeric_limits<double>::infinity();
    double second = first;
    for (Eigen::Index j = 0; j < in.rows(); ++j) {
      const double d = squared(queries, i, in, static_cast<std::uint32_t>(j));
      if (d < first) {
        second = first;
        first = d;
      } else {
        second = std::min(second, d);
      }
    }
    const NearestTwo& n = found[static_cast<std::size_t>(i)];
    ASSERT_NE(n.second, kNoNeighbour);
    ASSERT_NE(n.first, n.second);
    EXPECT_NEAR(squared(queries, i, in, n.first), first, 1e-5 * first);
    EXPECT_NEAR(squared(queries, i, in, n.second), second, 1e-5 * second);
    EXPECT_NEAR(static_cast<double>(n.second_squared), second, 1e-5 * second);
  }
}

class NearestTwoOf : public testing::TestWithParam<std::pair<int, double>> {};

TEST_P(NearestTwoOf, IsTheBruteForceAnswer) {
  const auto [columns, spread] = GetParam();
  const search::DescriptorMatrix source = clustered(700, columns, spread, 1);
  const search::DescriptorMatrix target = clustered(1000, columns, spread, 2);
  const TwoWayNearest found = nearest_two(source, target);
  expect_nearest(source, target, found.forward);
  expect_nearest(target, source, found.backward);
}

INSTANTIATE_TEST_SUITE_P(Sizes, NearestTwoOf,
                         testing::Values(std::pair{33, 0.01}, std::pair{33, 1.0}, std::pair{33, 40.0},
                                         std::pair{32, 5.0}, std::pair{3, 5.0}, std::pair{64, 1.0}));

TEST(NearestTwo, EqualRowsGoToTheLowest) {
  search::DescriptorMatrix target(200, 4);
  target.setConstant(2.0F);
  search::DescriptorMatrix source(1, 4);
  source << 1, 2, 3, 4;
  const TwoWayNearest found = nearest_two(source, target);
  EXPECT_EQ(found.forward[0].first, 0U);
  EXPECT_EQ(found.forward[0].second, 1U);
  EXPECT_EQ(found.backward[100].first, 0U);
  EXPECT_EQ(found.backward[100].second, kNoNeighbour);
}

/// By sums of squared float differences, which are exact for whole numbers; the lower row wins.
NearestTwo brute_force(const search::DescriptorMatrix& queries, Eigen::Index i, const search::DescriptorMatrix& in) {
  NearestTwo best;
  for (Eigen::Index j = 0; j < in.rows(); ++j) {
    const float d = (queries.row(i) - in.row(j)).squaredNorm();
    if (d < best.first_squared) {
      best.second = best.first;
      best.second_squared = best.first_squared;
      best.first = static_cast<std::uint32_t>(j);
      best.first_squared = d;
    } else if (d < best.second_squared) {
      best.second = static_cast<std::uint32_t>(j);
      best.second_squared = d;
    }
  }
  return best;
}

TEST(NearestTwo, ManyEqualDistancesAndALongRow) {
  Rng rng(11);
  const auto whole = [&](Eigen::Index rows) {
    search::DescriptorMatrix m(rows, 5);
    for (Eigen::Index k = 0; k < m.size(); ++k) {
      m.data()[k] = 1.0F + static_cast<float>(rng.below(3));
    }
    return m;
  };
  search::DescriptorMatrix source = whole(500);
  const search::DescriptorMatrix target = whole(400);
  source.row(77).setConstant(900.0F);  // all others are one step long beside it
  const TwoWayNearest found = nearest_two(source, target);
  const auto expect_same = [](const NearestTwo& a, const NearestTwo& b) {
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(a.second, b.second);
    EXPECT_EQ(a.first_squared, b.first_squared);
    EXPECT_EQ(a.second_squared, b.second_squared);
  };
  for (Eigen::Index i = 0; i < source.rows(); ++i) {
    expect_same(found.forward[static_cast<std::size_t>(i)], brute_force(source, i, target));
  }
  for (Eigen::Index j = 0; j < target.rows(); ++j) {
    expect_same(found.backward[static_cast<std::size_t>(j)], brute_force(target, j, source));
  }
}

TEST(NearestTwo, OnlyBrokenRowsOnOneSide) {
  const search::DescriptorMatrix zeros = search::DescriptorMatrix::Zero(20, 33);
  const TwoWayNearest found = nearest_two(zeros, clustered(30, 33, 1.0, 3));
  EXPECT_EQ(found.forward[0].first, kNoNeighbour);
  EXPECT_EQ(found.backward[0].first, kNoNeighbour);
}

TEST(NearestTwo, ZeroAndBrokenRowsHaveNoPart) {
  search::DescriptorMatrix source = clustered(50, 33, 1.0, 3);
  search::DescriptorMatrix target = clustered(60, 33, 1.0, 4);
  source.row(5).setZero();
  target.row(7).setZero();
  target(8, 3) = std::numeric_limits<float>::quiet_NaN();
  const TwoWayNearest found = nearest_two(source, target);
  EXPECT_EQ(found.forward[5].first, kNoNeighbour);
  EXPECT_EQ(found.backward[7].first, kNoNeighbour);
  EXPECT_EQ(found.backward[8].first, kNoNeighbour);
  for (const NearestTwo& n : found.forward) {
    EXPECT_TRUE(n.first != 7 && n.first != 8 && n.second != 7 && n.second != 8);
  }
}

TEST(NearestTwo, SameAnswerAtAnyNumberOfThreads) {
  const search::DescriptorMatrix source = clustered(900, 33, 3.0, 5);
  const search::DescriptorMatrix target = clustered(900, 33, 3.0, 6);
  set_thread_count(1);
  const TwoWayNearest one = nearest_two(source, target);
  set_thread_count(4);
  const TwoWayNearest four = nearest_two(source, target);
  set_thread_count(0);
  for (std::size_t i = 0; i < 900; ++i) {
    EXPECT_EQ(one.forward[i].first, four.forward[i].first);
    EXPECT_EQ(one.forward[i].second_squared, four.forward[i].second_squared);
  }
}

TEST(NearestTwo, TakesEmptyAndRefusesUnequal) {
  EXPECT_EQ(nearest_two(search::DescriptorMatrix(0, 33), clustered(5, 33, 1, 7)).backward[0].first, kNoNeighbour);
  EXPECT_THROW(nearest_two(clustered(5, 32, 1, 7), clustered(5, 33, 1, 7)), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::matching
