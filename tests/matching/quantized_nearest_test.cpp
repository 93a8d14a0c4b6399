// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../../libs/matching/src/brute_force_kernel.hpp"
#include "../../libs/matching/src/quantized_products.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/matching/nearest_two.hpp"

namespace loopmark::matching {
namespace {

/// Numbers from -largest to largest: small ones make many equal distances.
search::QuantizedDescriptors random_rows(Eigen::Index rows, Eigen::Index columns, std::uint32_t largest,
                                         std::uint64_t seed) {
  Rng rng(seed);
  search::QuantizedDescriptors m(rows, columns);
  for (Eigen::Index k = 0; k < m.size(); ++k) {
    m.data()[k] = static_cast<std::int8_t>(static_cast<int>(rng.below(2 * largest + 1)) - static_cast<int>(largest));
  }
  return m;
}

/// The definition: all distances, the two least, the lower row among equals, zero rows left out.
std::vector<NearestTwo> by_definition(const search::QuantizedDescriptors& queries,
                                      const search::QuantizedDescriptors& in) {
  std::vector<NearestTwo> out(static_cast<std::size_t>(queries.rows()));
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    NearestTwo& two = out[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < in.rows() && !queries.row(i).isZero(); ++j) {
      const auto d = static_cast<float>((queries.row(i).cast<int>() - in.row(j).cast<int>()).squaredNorm());
      if (in.row(j).isZero()) {
        continue;
      }
      if (d < two.first_squared) {
        two.second = two.first;
        two.second_squared = two.first_squared;
        two.first = static_cast<std::uint32_t>(j);
        two.first_squared = d;
      } else if (d < two.second_squared) {
        two.second = static_cast<std::uint32_t>(j);
        two.second_squared = d;
      }
    }
  }
  return out;
}

void expect_same(const std::vector<NearestTwo>& a, const std::vector<NearestTwo>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].first, b[i].first) << "row " << i;
    EXPECT_EQ(a[i].second, b[i].second) << "row " << i;
    EXPECT_EQ(a[i].first_squared, b[i].first_squared) << "row " << i;
    EXPECT_EQ(a[i].second_squared, b[i].second_squared) << "row " << i;
  }
}

struct Shape {
  Eigen::Index source;
  Eigen::Index target;
  Eigen::Index columns;
  std::uint32_t largest;
};

class QuantizedNearestTwo : public testing::TestWithParam<Shape> {};

TEST_P(QuantizedNearestTwo, IsTheBruteForceAnswerInBothDirections) {
  const Shape shape = GetParam();
  search::QuantizedDescriptors source = random_rows(shape.source, shape.columns, shape.largest, 1);
  search::QuantizedDescriptors target = random_rows(shape.target, shape.columns, shape.largest, 2);
  source.row(shape.source / 2).setZero();
  target.row(shape.target / 3).setZero();
  const TwoWayNearest found = nearest_two(source, target);
  expect_same(found.forward, by_definition(source, target));
  expect_same(found.backward, by_definition(target, source));
}

INSTANTIATE_TEST_SUITE_P(Shapes, QuantizedNearestTwo,
                         testing::Values(Shape{300, 277, 64, 127}, Shape{129, 40, 7, 2}, Shape{1, 1, 5, 127},
                                         Shape{17, 200, 992, 20}, Shape{200, 300, 3, 1}));

TEST(QuantizedNearestTwo, GivesTheSameAtAnyNumberOfThreads) {
  const search::QuantizedDescriptors source = random_rows(500, 12, 2, 3);
  const search::QuantizedDescriptors target = random_rows(400, 12, 2, 4);
  set_thread_count(1);
  const TwoWayNearest one = nearest_two(source, target);
  set_thread_count(3);
  const TwoWayNearest three = nearest_two(source, target);
  set_thread_count(0);
  expect_same(one.forward, three.forward);
  expect_same(one.backward, three.backward);
}

TEST(QuantizedNearestTwo, KnowsNoNeighbourInAnEmptyScanAndRefusesUnlikeLengths) {
  const search::QuantizedDescriptors some = random_rows(4, 8, 9, 5);
  const TwoWayNearest found = nearest_two(some, search::QuantizedDescriptors(0, 8));
  ASSERT_EQ(found.forward.size(), 4U);
  EXPECT_EQ(found.forward[0].first, kNoNeighbour);
  EXPECT_TRUE(found.backward.empty());
  EXPECT_THROW(nearest_two(some, random_rows(4, 9, 9, 6)), std::invalid_argument);
}

TEST(QuantizedProducts, AreExactOnEveryProcessorUpToTheLargestNumbers) {
  constexpr std::size_t kLength = 40;
  for (const std::uint32_t largest : {127U, 3U}) {
    search::QuantizedDescriptors a = random_rows(internal::kProductRows, kLength, largest, 7);
    search::QuantizedDescriptors b = random_rows(internal::kProductLanes, kLength, largest, 8);
    a.row(0).setConstant(127);
    a.row(1).setConstant(-127);
    b.row(0).setConstant(127);
    b.row(1).setConstant(-127);
    std::vector<std::int32_t> sums;
    for (Eigen::Index q = 0; q < a.rows(); ++q) {
      sums.push_back(a.row(q).cast<std::int32_t>().sum());
    }
    std::vector<std::int8_t> lanes;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kLength); i += internal::kProductStep) {
      for (Eigen::Index l = 0; l < b.rows(); ++l) {
        lanes.insert(lanes.end(), b.row(l).data() + i, b.row(l).data() + i + internal::kProductStep);
      }
    }
    std::vector<internal::QuantizedProducts> all = {internal::quantized_products_plain(),
                                                    internal::quantized_products()};
    if (internal::quantized_products_avx2() != nullptr && internal::processor_has_avx2()) {
      all.push_back(internal::quantized_products_avx2());
    }
    for (const internal::QuantizedProducts products_of : all) {
      std::vector<std::int32_t> products(internal::kProductRows * internal::kProductLanes);
      products_of(a.data(), sums.data(), lanes.data(), kLength, products.data());
      for (Eigen::Index q = 0; q < a.rows(); ++q) {
        for (Eigen::Index l = 0; l < b.rows(); ++l) {
          EXPECT_EQ(products[static_cast<std::size_t>(q * b.rows() + l)],
                    a.row(q).cast<std::int32_t>().dot(b.row(l).cast<std::int32_t>()));
        }
      }
    }
  }
}

}  // namespace
}  // namespace loopmark::matching
