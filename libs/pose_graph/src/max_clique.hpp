// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace loopmark::pose_graph::internal {

/// A symmetric relation between `size` things as rows of bits; nothing is related to itself.
class BitMatrix {
 public:
  explicit BitMatrix(std::size_t size) : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {}

  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  const std::uint64_t* row(std::size_t i) const { return bits_.data() + i * words_; }
  bool test(std::size_t i, std::size_t j) const { return (row(i)[j / 64] >> (j % 64) & 1U) != 0; }
  /// Relates i to j one way; different rows may be written by different threads.
  void set(std::size_t i, std::size_t j) { bits_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64); }
  std::size_t degree(std::size_t i) const;

 private:
  std::size_t size_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

/// A large set of mutually related things, in increasing order: the greedy heuristic of Pattabiraman et al. (2015)
/// from the 256 best connected starts, always adding the candidate with most neighbours among the candidates.
std::vector<std::size_t> large_clique(const BitMatrix& related);

}  // namespace loopmark::pose_graph::internal
