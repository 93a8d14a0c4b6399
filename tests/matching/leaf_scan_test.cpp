// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/matching/src/leaf_scan.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "../../libs/matching/src/feature_leaves.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark {
namespace {

using kernels::kChunk;

DescriptorMatrix random_rows(Eigen::Index columns, std::uint64_t seed) {
  Rng rng(seed);
  DescriptorMatrix m(static_cast<Eigen::Index>(kChunk), columns);
  for (Eigen::Index k = 0; k < m.size(); ++k) {
    m.data()[k] = static_cast<float>(rng.normal());
  }
  return m;
}

/// A chunk of descriptors, what it is as whole numbers, and where each row went.
struct Chunk {
  explicit Chunk(Eigen::Index columns, std::uint64_t seed)
      : rows(random_rows(columns, seed)),
        scale(WholeNumbers::of(static_cast<std::size_t>(columns), 30.0)),
        leaves(rows, rows, scale) {}

  DescriptorMatrix rows;
  WholeNumbers scale;
  FeatureLeaves leaves;
};

class LeafScan : public testing::TestWithParam<int> {};

TEST_P(LeafScan, FindsAllThatAreNearAndHardlyMoreOnEveryProcessor) {
  const int columns = GetParam();
  const Chunk a(columns, 1);
  const Chunk b(columns, 2);
  const float reach = 2.0F * static_cast<float>(columns);  // what half of the squared distances are below
  std::array<float, kChunk> squared;
  squared.fill(reach);
  std::array<std::int32_t, kChunk> limits;
  a.scale.limits(squared.data(), kChunk, limits.data());
  std::array<std::int32_t, kChunk> silent;
  silent.fill(kNotAsked);
  std::array<std::uint16_t, kChunk> plain;
  kernels::scan_chunks_plain()(a.leaves.queries(0, limits.data()), b.leaves.targets(0, silent.data()), a.leaves.pairs(),
                               plain.data());
  for (std::size_t q = 0; q < kChunk; ++q) {
    for (std::size_t t = 0; t < kChunk; ++t) {
      const float d = (a.rows.row(a.leaves.original(q)) - b.rows.row(b.leaves.original(t))).squaredNorm();
      const bool hit = (plain[q] >> t & 1) != 0;
      EXPECT_TRUE(hit || d > reach);
      EXPECT_TRUE(!hit || d < 1.01F * reach + 0.1F);
    }
  }
  for (const kernels::ScanChunks scan : {kernels::scan_chunks_avx2(), kernels::scan_chunks()}) {
    if (scan == nullptr || (scan == kernels::scan_chunks_avx2() && !kernels::processor_has_avx2())) {
      continue;
    }
    std::array<std::uint16_t, kChunk> hits;
    scan(a.leaves.queries(0, limits.data()), b.leaves.targets(0, silent.data()), a.leaves.pairs(), hits.data());
    EXPECT_EQ(hits, plain);
  }
  // The other way round, those of the targets that are asked for.
  std::array<std::uint16_t, kChunk> back;
  kernels::scan_chunks()(b.leaves.queries(0, silent.data()), a.leaves.targets(0, limits.data()), a.leaves.pairs(),
                         back.data());
  for (std::size_t q = 0; q < kChunk; ++q) {
    for (std::size_t t = 0; t < kChunk; ++t) {
      EXPECT_EQ(plain[q] >> t & 1, back[t] >> q & 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Columns, LeafScan, testing::Values(1, 4, 12, 13, 33, 64));

}  // namespace
}  // namespace loopmark
