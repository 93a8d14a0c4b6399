// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/consistency_graph.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "consistency_kernels.hpp"
#include "loopmark/core/parallel.hpp"
#include "scorer.hpp"

namespace loopmark::estimation {
namespace {

constexpr std::size_t kBlock = 64;  // rows a task, and bits a word

/// Packs 0/1 bytes into bits, from word `from` on.
void pack(const std::vector<std::uint8_t>& bytes, std::size_t from, std::size_t words, std::uint64_t* bits) {
  for (std::size_t w = from; w < words; ++w) {
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < 8; ++b) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, bytes.data() + w * 64 + b * 8, 8);
      word |= (eight * 0x0102040810204080ULL >> 56U) << (8 * b);
    }
    bits[w] = word;
  }
}

}  // namespace

ConsistencyGraph::ConsistencyGraph(const PointPairs& pairs, double tolerance_m)
    : size_(pairs.size()), words_((pairs.size() + 63) / 64), bits_(size_ * words_) {
  const internal::Scorer arrays(pairs, 1.0);
  parallel_for(words_, [&](std::size_t block) { compare(arrays, static_cast<float>(tolerance_m), block); });
  parallel_for(words_, [&](std::size_t block) { mirror(block); });
}

void ConsistencyGraph::compare(const internal::Scorer& arrays, float tolerance_m, std::size_t block) {
  std::vector<std::uint8_t> bytes(words_ * kBlock + internal::kPairLanes, 0);
  for (std::size_t i = block * kBlock; i < std::min(size_, (block + 1) * kBlock); ++i) {
    internal::consistency_row(arrays.arrays(), i, block * kBlock, tolerance_m, bytes.data());
    bytes[i] = 0;
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(size_), bytes.end(), std::uint8_t{0});
    pack(bytes, block, words_, bits_.data() + i * words_);
  }
}

void ConsistencyGraph::mirror(std::size_t block) {
  std::array<std::uint64_t, kBlock> square{};
  const std::size_t rows = std::min(kBlock, size_ - block * kBlock);
  for (std::size_t other = 0; other < block; ++other) {
    for (std::size_t r = 0; r < kBlock; ++r) {
      square[r] = bits_[(other * kBlock + r) * words_ + block];
    }
    internal::transpose_bits(square.data());
    for (std::size_t r = 0; r < rows; ++r) {
      bits_[(block * kBlock + r) * words_ + other] = square[r];
    }
  }
}

std::size_t ConsistencyGraph::degree(std::size_t i) const { return internal::common_bits(row(i), row(i), words_); }

std::size_t ConsistencyGraph::common(std::size_t i, std::size_t j) const {
  return internal::common_bits(row(i), row(j), words_);
}

std::vector<std::size_t> core_numbers(const ConsistencyGraph& graph) {
  const std::size_t n = graph.size();
  std::vector<std::uint32_t> degree(n);
  parallel_for(
      n, [&](std::size_t i) { degree[i] = static_cast<std::uint32_t>(graph.degree(i)); }, kBlock);
  // Vertices sorted by degree, with the start of each degree's run, kept sorted while degrees fall.
  const std::uint32_t highest = n == 0 ? 0 : *std::max_element(degree.begin(), degree.end());
  std::vector<std::uint32_t> start(highest + 2, 0);
  for (const std::uint32_t d : degree) {
    ++start[d + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> order(n);
  std::vector<std::uint32_t> place(n);
  std::vector<std::uint32_t> fill = start;
  for (std::uint32_t i = 0; i < n; ++i) {
    place[i] = fill[degree[i]]++;
    order[place[i]] = i;
  }
  std::vector<std::uint64_t> left(graph.words(), ~std::uint64_t{0});
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t v = order[k];
    left[v / 64] &= ~(std::uint64_t{1} << (v % 64));
    graph.for_each_neighbour(v, left.data(), [&](std::size_t u) {
      if (degree[u] <= degree[v]) {
        return;
      }
      const std::uint32_t front = std::max(start[degree[u]], k + 1);
      const std::uint32_t w = order[front];
      std::swap(order[place[u]], order[front]);
      std::swap(place[u], place[w]);
      start[degree[u]] = front + 1;
      --degree[u];
    });
  }
  return {degree.begin(), degree.end()};
}

std::vector<std::size_t> maximum_core(const ConsistencyGraph& graph) {
  const std::vector<std::size_t> cores = core_numbers(graph);
  std::vector<std::size_t> members;
  if (cores.empty()) {
    return members;
  }
  const std::size_t highest = *std::max_element(cores.begin(), cores.end());
  for (std::size_t i = 0; i < cores.size(); ++i) {
    if (cores[i] == highest) {
      members.push_back(i);
    }
  }
  return members;
}

namespace {

/// Greedy clique around one vertex: its neighbours, those that share most with it first.
std::vector<std::size_t> clique_around(const ConsistencyGraph& graph, std::size_t seed) {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // (-shared, vertex)
  graph.for_each_neighbour(seed, [&](std::size_t v) { order.emplace_back(graph.size() - graph.common(seed, v), v); });
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> clique{seed};
  std::vector<std::uint64_t> candidates(graph.row(seed), graph.row(seed) + graph.words());
  for (const auto& [missing, v] : order) {
    if ((candidates[v / 64] >> (v % 64) & 1U) == 0) {
      continue;
    }
    clique.push_back(v);
    for (std::size_t w = 0; w < candidates.size(); ++w) {
      candidates[w] &= graph.row(v)[w];
    }
  }
  return clique;
}

}  // namespace

std::vector<std::size_t> large_clique(const ConsistencyGraph& graph, std::size_t seeds) {
  const std::vector<std::size_t> cores = core_numbers(graph);
  std::vector<std::size_t> order(graph.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cores[a] > cores[b]; });
  order.resize(std::min(order.size(), seeds));
  std::vector<std::vector<std::size_t>> cliques(order.size());
  parallel_for(order.size(), [&](std::size_t k) { cliques[k] = clique_around(graph, order[k]); });
  std::vector<std::size_t> best;
  for (const auto& clique : cliques) {
    if (clique.size() > best.size()) {
      best = clique;
    }
  }
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace loopmark::estimation
