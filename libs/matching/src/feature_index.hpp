// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "loopmark/matching/nearest_two.hpp"
#include "nearest_two_kernels.hpp"

namespace loopmark {

/// The first principal directions of descriptors: an orthonormal projection, in which distances are lower bounds of the
/// true ones, plus the length of what the projection leaves out.
struct PrincipalFrame {
  Eigen::VectorXd mean;
  Eigen::MatrixXd directions;  ///< one column a direction, kHead + kMore of them (zero columns where fewer)
  double largest = 0.0;        ///< longest centred descriptor seen so far

  static PrincipalFrame of(const DescriptorMatrix& a, const DescriptorMatrix& b);
};

/// Descriptors of one cloud sorted into leaves of near neighbours.
class FeatureIndex {
 public:
  FeatureIndex(const DescriptorMatrix& descriptors, const PrincipalFrame& frame);

  std::size_t size() const { return order_.size(); }
  std::size_t leaves() const { return leaves_; }
  /// Original row of the descriptor at a place of the leaf order.
  std::uint32_t original(std::size_t place) const { return order_[place]; }
  double largest() const { return largest_; }

  /// Searches the two nearest of the descriptors at places [begin, end) of `queries` (one leaf of them).
  void search(const FeatureIndex& queries, std::size_t begin, std::size_t end, double slack,
              std::vector<NearestTwo>& out) const;

 private:
  struct Search;
  struct Candidates;
  /// Bounds of all leaves from the box of a chunk of queries.
  void nearest_leaf(const FeatureIndex& queries, std::size_t chunk, Candidates& candidates) const;
  void gather(float threshold, Candidates& candidates) const;
  void sort_into_leaves(std::uint32_t begin, std::uint32_t end, const std::vector<float>& bounds);
  void fill(const DescriptorMatrix& descriptors, const std::vector<float>& bounds);
  const float* row(std::size_t place) const { return rows_.data() + place * padded_; }
  void offer(Search& search, std::size_t place) const;
  void search_leaf(Search& search, std::size_t leaf) const;

  std::size_t padded_ = 0;
  std::size_t leaves_ = 0;
  double largest_ = 0.0;
  std::vector<std::uint32_t> order_;
  std::vector<float> rows_;        ///< padded descriptors in leaf order
  std::vector<float> heads_;       ///< bound coordinates of each descriptor in leaf order, [size][kFine]
  std::vector<float> lanes_;       ///< the same, chunk by chunk, [kFine][kChunk]
  std::vector<float> low_, high_;  ///< boxes of the leaves, [kBound][leaves]
  std::vector<float> boxes_;       ///< boxes of the chunks, leaf by leaf: low, high, [kBound][kChunks] each
};

}  // namespace loopmark
