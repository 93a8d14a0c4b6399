// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::estimation {

namespace internal {
class Scorer;
}  // namespace internal

/// Which matches may be right together: two are joined when the distance of their points is the same in both
/// scans, whatever the motion (the translation- and rotation-invariant measurements of TEASER, Yang et al. 2021; the
/// first-order compatibility of SC2-PCR, Chen et al. 2022). One bit a pair of matches: n^2 / 8 bytes.
class ConsistencyGraph {
 public:
  /// Joins matches whose distances differ by less than `tolerance_m`.
  ConsistencyGraph(const PointPairs& pairs, double tolerance_m);

  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  bool joined(std::size_t i, std::size_t j) const { return (row(i)[j / 64] >> (j % 64) & 1U) != 0; }
  const std::uint64_t* row(std::size_t i) const { return bits_.data() + i * words_; }
  std::size_t degree(std::size_t i) const;
  /// Number of matches joined to both (second-order compatibility counts these where i and j are joined).
  std::size_t common(std::size_t i, std::size_t j) const;

  /// Calls visit(j) for the neighbours of i, ascending.
  template <class Visit>
  void for_each_neighbour(std::size_t i, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w) {
      visit_bits(w, row(i)[w], visit);
    }
  }

  /// The same for those neighbours whose bit is set in `among` (words() words).
  template <class Visit>
  void for_each_neighbour(std::size_t i, const std::uint64_t* among, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w) {
      visit_bits(w, row(i)[w] & among[w], visit);
    }
  }

 private:
  /// Fills the rows of a block from its diagonal on; mirror fills what is left of the diagonal from the rows above.
  void compare(const internal::Scorer& arrays, float tolerance_m, std::size_t block);
  void mirror(std::size_t block);

  template <class Visit>
  static void visit_bits(std::size_t word, std::uint64_t bits, const Visit& visit) {
    for (; bits != 0; bits &= bits - 1) {
      visit(word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits)));
    }
  }

  std::size_t size_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

/// Core number of every vertex: the largest k such that it lies in a subgraph of least degree k (Batagelj and
/// Zaversnik 2003).
std::vector<std::size_t> core_numbers(const ConsistencyGraph& graph);

/// The vertices of the highest core number, ascending (KISS-Matcher, Lim et al. 2024).
std::vector<std::size_t> maximum_core(const ConsistencyGraph& graph);

/// A large clique, ascending: greedy from each of the `seeds` vertices of highest core number, by the number of
/// neighbours shared with the seed. Not always the maximum one.
std::vector<std::size_t> large_clique(const ConsistencyGraph& graph, std::size_t seeds);

}  // namespace loopmark::estimation
