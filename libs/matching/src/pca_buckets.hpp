// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "brute_force_kernel.hpp"
#include "loopmark/search/descriptor_matrix.hpp"
#include "nearest_two_kernels.hpp"

namespace loopmark::matching::internal {

/// From descriptors to whole numbers: coordinates are multiplied by `factor` and rounded.
struct WholeNumbers {
  double factor = 1.0;
  double rounding = 0.0;  ///< distances of whole numbers are off by at most this
  float slack = 0.0F;     ///< what rounded coordinates may add to squared distances

  /// For rows of so many coordinates, none longer than `longest`.
  static WholeNumbers of(std::size_t dimension, double longest);

  /// Rows whose true squared distance is squared[i] or less are less than limits[i] apart in whole numbers, squared.
  void limits(const float* squared, std::size_t count, std::int32_t* limits) const;
};

/// Of the rows that are finite.
double longest_row(const search::DescriptorMatrix& rows);

constexpr std::int32_t kNoLimit = 1 << 30;  ///< above every squared distance of whole numbers
constexpr std::int32_t kNotAsked = -1;      ///< below every one
constexpr double kLongest = 16000.0;        ///< length of the longest row in whole numbers

/// The usable descriptors of one cloud, sorted into chunks and leaves of near ones. A place is a number in this order.
class PcaBuckets {
 public:
  PcaBuckets() = default;
  /// `rotated`: the rows in their principal frame.
  PcaBuckets(const search::DescriptorMatrix& rows, const search::DescriptorMatrix& rotated, const WholeNumbers& scale);

  std::size_t size() const { return order_.size(); }
  std::size_t leaves() const { return leaves_; }
  std::size_t chunks() const { return (size() + kChunk - 1) / kChunk; }
  std::size_t pairs() const { return pairs_; }
  /// Row of the descriptor at a place in the matrix given.
  std::uint32_t original(std::size_t place) const { return order_[place]; }
  /// The descriptor itself, filled up with zeros to padded() floats.
  const float* row(std::size_t place) const { return rows_.data() + place * padded_; }
  std::size_t padded() const { return padded_; }

  /// `limits`: of all places (chunks() * kChunk).
  QueryChunk queries(std::size_t chunk, const std::int32_t* limits) const;
  TargetChunk targets(std::size_t chunk, const std::int32_t* limits) const;

  /// Lower bounds of the squared distance between a chunk of `other` and each leaf, or each of the kChunks of a leaf.
  void bounds_to_leaves(const PcaBuckets& other, std::size_t chunk, std::vector<float>& bounds) const;
  void bounds_to_chunks(const PcaBuckets& other, std::size_t chunk, std::size_t leaf, float* bounds) const;

 private:
  /// low and high: [kBox][count].
  struct Boxes {
    std::vector<float> low, high;
    std::size_t count = 0;

    explicit Boxes(std::size_t boxes);
    void add(std::size_t box, const float* point);
  };

  using Corner = std::array<float, kBox>;
  std::pair<Corner, Corner> box_of(std::size_t chunk) const;
  using Keys = std::vector<std::pair<float, std::uint32_t>>;
  void sort_into_leaves(std::uint32_t begin, std::uint32_t end, const std::vector<Corner>& heads, Keys& keys);
  void fill_words(const search::DescriptorMatrix& rotated, double factor);
  void fill_boxes(const std::vector<Corner>& heads);

  std::size_t padded_ = 0;
  std::size_t pairs_ = 0;
  std::size_t leaves_ = 0;
  std::vector<std::uint32_t> order_;
  std::vector<float> rows_;
  std::vector<std::int32_t> as_queries_, as_targets_;  ///< words, as QueryChunk and TargetChunk take them
  std::vector<std::int32_t> head_norms_, norms_;
  Boxes of_leaves_{0};
  std::vector<Boxes> of_chunks_;  ///< for each leaf those of its chunks
};

}  // namespace loopmark::matching::internal
