// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "max_clique.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace loopmark::pose_graph::internal {
namespace {

constexpr std::size_t kStarts = 256;
/// Above it, candidates are ranked by their degree in the whole relation instead of among the candidates.
constexpr std::size_t kExactRanking = 512;

using Bits = std::vector<std::uint64_t>;

std::size_t common(const Bits& candidates, const std::uint64_t* row) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < candidates.size(); ++w) {
    count += static_cast<std::size_t>(std::popcount(candidates[w] & row[w]));
  }
  return count;
}

template <class Visit>
void for_each_bit(const Bits& bits, const Visit& visit) {
  for (std::size_t w = 0; w < bits.size(); ++w) {
    for (std::uint64_t word = bits[w]; word != 0; word &= word - 1) {
      visit(64 * w + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }
}

/// The candidate with most neighbours; the smallest of equals.
std::size_t best_candidate(const BitMatrix& related, const Bits& candidates, const std::vector<std::size_t>& degrees) {
  const bool exact = related.size() <= kExactRanking;
  std::size_t best = related.size();
  std::size_t best_rank = 0;
  for_each_bit(candidates, [&](std::size_t i) {
    const std::size_t rank = exact ? common(candidates, related.row(i)) : degrees[i];
    if (best == related.size() || rank > best_rank) {
      best = i;
      best_rank = rank;
    }
  });
  return best;
}

std::vector<std::size_t> grow(const BitMatrix& related, std::size_t start, const std::vector<std::size_t>& degrees) {
  std::vector<std::size_t> clique = {start};
  Bits candidates(related.row(start), related.row(start) + related.words());
  for (std::size_t next = best_candidate(related, candidates, degrees); next < related.size();
       next = best_candidate(related, candidates, degrees)) {
    clique.push_back(next);
    for (std::size_t w = 0; w < candidates.size(); ++w) {
      candidates[w] &= related.row(next)[w];
    }
  }
  return clique;
}

}  // namespace

std::size_t BitMatrix::degree(std::size_t i) const {
  return std::accumulate(row(i), row(i) + words_, std::size_t{0}, [](std::size_t sum, std::uint64_t word) {
    return sum + static_cast<std::size_t>(std::popcount(word));
  });
}

std::vector<std::size_t> large_clique(const BitMatrix& related) {
  std::vector<std::size_t> degrees(related.size());
  std::vector<std::size_t> order(related.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const std::size_t i : order) {
    degrees[i] = related.degree(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return degrees[a] > degrees[b]; });
  std::vector<std::size_t> best;
  for (std::size_t s = 0; s < std::min(kStarts, order.size()); ++s) {
    if (degrees[order[s]] + 1 <= best.size()) {
      break;  // Neither this start nor any later one can do better.
    }
    std::vector<std::size_t> clique = grow(related, order[s], degrees);
    if (clique.size() > best.size()) {
      best = std::move(clique);
    }
  }
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace loopmark::pose_graph::internal
