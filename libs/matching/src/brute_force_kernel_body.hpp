// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// scan_chunks for one instruction set. Everything here is local to the file that includes it: each is compiled with
/// flags of its own.
#pragma once

#include "brute_force_kernel.hpp"

namespace loopmark::matching::internal {
namespace {

/// Subtracts 2 a b for pairs [from, to): |b|^2 - 2 a b.
template <class Isa>
[[gnu::always_inline]] inline void add_products(const std::int32_t* queries, const std::int32_t* targets,
                                                std::size_t pairs, std::size_t from, std::size_t to,
                                                typename Isa::Vector (&sums)[kQueries]) {
  for (std::size_t p = from; p < to; ++p) {
    const auto b = Isa::load(targets + p * kChunk);
    for (std::size_t q = 0; q < kQueries; ++q) {
      sums[q] = Isa::add(sums[q], Isa::multiply_pairs(Isa::spread(queries[q * pairs + p]), b));
    }
  }
}

/// The lanes below one of the limits, for each query; the lengths of the queries are not in the sums yet.
template <class Isa>
[[gnu::always_inline]] inline std::uint32_t below(const std::int32_t* norms, const std::int32_t* query_limits,
                                                  typename Isa::Vector target_limits,
                                                  const typename Isa::Vector (&sums)[kQueries],
                                                  std::uint32_t (&lanes)[kQueries]) {
  std::uint32_t any = 0;
  for (std::size_t q = 0; q < kQueries; ++q) {
    const auto limit = Isa::subtract(Isa::larger(Isa::spread(query_limits[q]), target_limits), Isa::spread(norms[q]));
    lanes[q] = Isa::less(sums[q], limit);
    any |= lanes[q];
  }
  return any;
}

template <class Isa>
bool scan(const QueryChunk& queries, const TargetChunk& targets, std::size_t pairs, std::uint16_t* hits) {
  const std::size_t head = pairs < kHeadPairs ? pairs : kHeadPairs;
  for (std::size_t q = 0; q < kChunk; ++q) {
    hits[q] = 0;
  }
  std::uint32_t found = 0;
  for (std::size_t lane = 0; lane < kChunk; lane += Isa::kLanes) {
    const auto head_norms = Isa::load(targets.head_norms + lane);
    const auto rest_norms = Isa::subtract(Isa::load(targets.norms + lane), head_norms);
    const auto limits = Isa::load(targets.limits + lane);
    for (std::size_t first = 0; first < kChunk; first += kQueries) {
      const std::int32_t* words = queries.words + first * pairs;
      typename Isa::Vector sums[kQueries] = {head_norms, head_norms, head_norms, head_norms};
      std::uint32_t lanes[kQueries];
      add_products<Isa>(words, targets.words + lane, pairs, 0, head, sums);
      if (below<Isa>(queries.head_norms + first, queries.limits + first, limits, sums, lanes) == 0) {
        continue;
      }
      for (auto& sum : sums) {
        sum = Isa::add(sum, rest_norms);
      }
      add_products<Isa>(words, targets.words + lane, pairs, head, pairs, sums);
      found |= below<Isa>(queries.norms + first, queries.limits + first, limits, sums, lanes);
      for (std::size_t q = 0; q < kQueries; ++q) {
        hits[first + q] = static_cast<std::uint16_t>(hits[first + q] | lanes[q] << lane);
      }
    }
  }
  return found != 0;
}

}  // namespace
}  // namespace loopmark::matching::internal
