// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "loopmark/matching/nearest_two.hpp"
#include "pca_buckets.hpp"

namespace loopmark::matching::internal {

constexpr float kBoundRounding = 1.001F;  ///< boxes are made of rounded coordinates

/// The nearest two found so far of every place of one cloud, in the other; and from where on others are too far.
class NearestAnswers {
 public:
  NearestAnswers(const PcaBuckets& asking, const WholeNumbers& scale)
      : asking_(&asking),
        scale_(scale),
        best_(asking.size()),
        limits_(asking.chunks() * kChunk, kNotAsked),
        reach_(asking.chunks(), std::numeric_limits<float>::infinity()),
        leaf_reach_(asking.leaves(), std::numeric_limits<float>::infinity()) {
    std::fill_n(limits_.begin(), asking.size(), kNoLimit);
  }

  const std::int32_t* limits() const { return limits_.data(); }
  /// Squared distance within which a place of the chunk still looks for neighbours.
  float reach(std::size_t chunk) const { return reach_[chunk]; }
  float reach_of_leaf(std::size_t leaf) const { return leaf_reach_[leaf]; }

  /// Whether a row of the other cloud could be taken at all: of many equal descriptors most need no look.
  bool is_open_to(std::size_t place, std::uint32_t id) const {
    return best_[place].second_squared > 0.0F || id < best_[place].second;
  }

  /// Takes a row of the other cloud at a squared distance for a place of this, if it is nearer than what is known.
  /// Among equal distances the lower row wins. Tells whether it was taken.
  bool offer(std::size_t place, std::uint32_t id, float squared) {
    NearestTwo& best = best_[place];
    const auto before = [&](float d, std::uint32_t known) { return squared < d || (squared == d && id < known); };
    if (!before(best.second_squared, best.second) || id == best.first) {
      return false;
    }
    if (before(best.first_squared, best.first)) {
      best.second = best.first;
      best.second_squared = best.first_squared;
      best.first = id;
      best.first_squared = squared;
    } else {
      best.second = id;
      best.second_squared = squared;
    }
    return true;
  }

  /// After offers taken by places of a chunk: others are too far from now on.
  void narrow(std::size_t chunk) {
    const std::size_t begin = chunk * kChunk;
    const std::size_t end = std::min(best_.size(), begin + kChunk);
    std::array<float, kChunk> squared{};
    for (std::size_t place = begin; place < end; ++place) {
      squared[place - begin] = best_[place].second_squared;
    }
    scale_.limits(squared.data(), end - begin, limits_.data() + begin);
    reach_[chunk] = *std::max_element(squared.begin(), squared.end()) * kBoundRounding + scale_.slack;
    const auto first = reach_.begin() + static_cast<std::ptrdiff_t>(chunk / kChunks * kChunks);
    const auto last = first + std::min<std::ptrdiff_t>(kChunks, reach_.end() - first);
    leaf_reach_[chunk / kChunks] = *std::max_element(first, last);
  }

  /// Takes over what others found for the same places.
  void take(const NearestAnswers& others) {
    for (std::size_t place = 0; place < best_.size(); ++place) {
      const NearestTwo& theirs = others.best_[place];
      offer(place, theirs.first, theirs.first_squared);
      offer(place, theirs.second, theirs.second_squared);
    }
  }

  /// By rows of the matrix.
  void write(std::vector<NearestTwo>& out) const {
    for (std::size_t place = 0; place < best_.size(); ++place) {
      out[asking_->original(place)] = best_[place];
    }
  }

 private:
  const PcaBuckets* asking_;
  WholeNumbers scale_;
  std::vector<NearestTwo> best_;
  std::vector<std::int32_t> limits_;
  std::vector<float> reach_;
  std::vector<float> leaf_reach_;
};

}  // namespace loopmark::matching::internal
