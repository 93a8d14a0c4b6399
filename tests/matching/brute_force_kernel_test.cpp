// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/matching/src/brute_force_kernel.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "../../libs/matching/src/pca_buckets.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::matching {
namespace {

using internal::kChunk;

search::DescriptorMatrix random_rows(Eigen::Index columns, std::uint64_t seed) {
  Rng rng(seed);
  search::DescriptorMatrix m(static_cast<Eigen::Index>(internal::kChunk), columns);
  for (Eigen::Index k = 0; k < m.size(); ++k) {
    m.data()[k] = static_cast<float>(rng.normal());
  }
  return m;
}

/// A chunk of descriptors, what it is as whole numbers, and where each row went.
struct Chunk {
  explicit Chunk(Eigen::Index columns, std::uint64_t seed)
      : rows(random_rows(columns, seed)),
        scale(internal::WholeNumbers::of(static_cast<std::size_t>(columns), 30.0)),
        leaves(rows, rows, scale) {}

  search::DescriptorMatrix rows;
  internal::WholeNumbers scale;
  internal::PcaBuckets leaves;
};

class BruteForceKernel : public testing::TestWithParam<int> {};

TEST_P(BruteForceKernel, FindsAllThatAreNearAndHardlyMoreOnEveryProcessor) {
  const int columns = GetParam();
  const Chunk a(columns, 1);
  const Chunk b(columns, 2);
  const float reach = 2.0F * static_cast<float>(columns);  // what half of the squared distances are below
  std::array<float, internal::kChunk> squared;
  squared.fill(reach);
  std::array<std::int32_t, internal::kChunk> limits;
  a.scale.limits(squared.data(), internal::kChunk, limits.data());
  std::array<std::int32_t, internal::kChunk> silent;
  silent.fill(internal::kNotAsked);
  std::array<std::uint16_t, internal::kChunk> plain;
  internal::scan_chunks_plain()(a.leaves.queries(0, limits.data()), b.leaves.targets(0, silent.data()),
                                a.leaves.pairs(), plain.data());
  for (std::size_t q = 0; q < internal::kChunk; ++q) {
    for (std::size_t t = 0; t < internal::kChunk; ++t) {
      const float d = (a.rows.row(a.leaves.original(q)) - b.rows.row(b.leaves.original(t))).squaredNorm();
      const bool hit = (plain[q] >> t & 1) != 0;
      EXPECT_TRUE(hit || d > reach);
      EXPECT_TRUE(!hit || d < 1.01F * reach + 0.1F);
    }
  }
  for (const internal::ScanChunks scan : {internal::scan_chunks_avx2(), internal::scan_chunks()}) {
    if (scan == nullptr || (scan == internal::scan_chunks_avx2() && !internal::processor_has_avx2())) {
      continue;
    }
    std::array<std::uint16_t, internal::kChunk> hits;
    scan(a.leaves.queries(0, limits.data()), b.leaves.targets(0, silent.data()), a.leaves.pairs(), hits.data());
    EXPECT_EQ(hits, plain);
  }
  // The other way round, those of the targets that are asked for.
  std::array<std::uint16_t, internal::kChunk> back;
  internal::scan_chunks()(b.leaves.queries(0, silent.data()), a.leaves.targets(0, limits.data()), a.leaves.pairs(),
                          back.data());
  for (std::size_t q = 0; q < internal::kChunk; ++q) {
    for (std::size_t t = 0; t < internal::kChunk; ++t) {
      EXPECT_EQ(plain[q] >> t & 1, back[t] >> q & 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Columns, BruteForceKernel, testing::Values(1, 4, 12, 13, 33, 64));

}  // namespace
}  // namespace loopmark::matching
