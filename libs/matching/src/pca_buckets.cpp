// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pca_buckets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pca_basis.hpp"

namespace loopmark::matching::internal {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int32_t kFarOff = 1 << 29;  // squared length of a place that holds nothing

/// The coordinates of each row that boxes and splits use; zeros where descriptors have fewer.
std::vector<std::array<float, kBox>> heads_of(const search::DescriptorMatrix& rotated) {
  std::vector<std::array<float, kBox>> heads(static_cast<std::size_t>(rotated.rows()));
  const auto columns = std::min(static_cast<std::size_t>(rotated.cols()), kBox);
  for (std::size_t r = 0; r < heads.size(); ++r) {
    std::copy_n(rotated.data() + r * static_cast<std::size_t>(rotated.cols()), columns, heads[r].begin());
  }
  return heads;
}

std::int32_t word_of(std::int32_t low, std::int32_t high) {
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(high) << 16U) |
                                   (static_cast<std::uint32_t>(low) & 0xFFFFU));
}

}  // namespace

double longest_row(const search::DescriptorMatrix& rows) {
  float longest = 0.0F;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const float squared = rows.row(r).squaredNorm();
    longest = std::isfinite(squared) ? std::max(longest, squared) : longest;
  }
  return std::sqrt(1.0001 * static_cast<double>(longest));
}

WholeNumbers WholeNumbers::of(std::size_t dimension, double longest) {
  const auto d = static_cast<double>(dimension);
  WholeNumbers scale;
  scale.factor = longest > 0.0 ? kLongest / longest : 1.0;
  // Of each coordinate of a difference half a step twice, and what the rotation was rounded by.
  scale.rounding = std::sqrt(d) * (1.0 + 4e-7 * d * kLongest);
  const double coordinate = 1e-6 * longest;
  scale.slack = static_cast<float>(1000.0 * coordinate * coordinate);
  return scale;
}

void WholeNumbers::limits(const float* squared, std::size_t count, std::int32_t* limits) const {
  const auto f = static_cast<float>(factor);
  const auto off = static_cast<float>(rounding);
  for (std::size_t i = 0; i < count; ++i) {
    const float apart = std::sqrt(squared[i]) * f + off;
    const float limit = apart * apart * 1.0001F + 2.0F;  // of float's rounding, a thousandfold
    limits[i] = static_cast<std::int32_t>(limit < static_cast<float>(kNoLimit) ? limit : static_cast<float>(kNoLimit));
  }
}

PcaBuckets::Boxes::Boxes(std::size_t boxes)
    : low(kBox * boxes, kInfinity), high(kBox * boxes, -kInfinity), count(boxes) {}

void PcaBuckets::Boxes::add(std::size_t box, const float* point) {
  for (std::size_t d = 0; d < kBox; ++d) {
    low[d * count + box] = std::min(low[d * count + box], point[d]);
    high[d * count + box] = std::max(high[d * count + box], point[d]);
  }
}

PcaBuckets::PcaBuckets(const search::DescriptorMatrix& rows, const search::DescriptorMatrix& rotated,
                       const WholeNumbers& scale)
    : padded_((static_cast<std::size_t>(rows.cols()) + kRowStep - 1) / kRowStep * kRowStep),
      pairs_((static_cast<std::size_t>(rows.cols()) + 1) / 2) {
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    if (is_usable(rows, r)) {
      order_.push_back(static_cast<std::uint32_t>(r));
    }
  }
  leaves_ = (order_.size() + kLeaf - 1) / kLeaf;
  const std::vector<Corner> heads = heads_of(rotated);
  Keys keys;
  sort_into_leaves(0, static_cast<std::uint32_t>(order_.size()), heads, keys);
  const auto columns = static_cast<std::size_t>(rows.cols());
  rows_.assign(order_.size() * padded_, 0.0F);
  for (std::size_t place = 0; place < order_.size(); ++place) {
    std::copy_n(rows.data() + order_[place] * columns, columns, rows_.data() + place * padded_);
  }
  fill_words(rotated, scale.factor);
  fill_boxes(heads);
}

/// Splits along the widest coordinate, at a multiple of kLeaf, within a leaf of kChunk, until one chunk is left.
void PcaBuckets::sort_into_leaves(std::uint32_t begin, std::uint32_t end, const std::vector<Corner>& heads,
                                  Keys& keys) {
  const std::size_t part = end - begin > kLeaf ? kLeaf : kChunk;
  const std::size_t parts = (end - begin + part - 1) / part;
  if (parts <= 1) {
    return;
  }
  Corner low = heads[order_[begin]];
  Corner high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Corner& head = heads[order_[i]];
    for (std::size_t d = 0; d < kBox; ++d) {
      low[d] = std::min(low[d], head[d]);
      high[d] = std::max(high[d], head[d]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t d = 1; d < kBox; ++d) {
    widest = high[d] - low[d] > high[widest] - low[widest] ? d : widest;
  }
  const auto middle = static_cast<std::ptrdiff_t>((parts + 1) / 2 * part);
  keys.clear();
  for (std::uint32_t i = begin; i < end; ++i) {
    keys.emplace_back(heads[order_[i]][widest], order_[i]);
  }
  std::nth_element(keys.begin(), keys.begin() + middle, keys.end());
  std::transform(keys.begin(), keys.end(), order_.begin() + begin, [](const auto& key) { return key.second; });
  sort_into_leaves(begin, begin + static_cast<std::uint32_t>(middle), heads, keys);
  sort_into_leaves(begin + static_cast<std::uint32_t>(middle), end, heads, keys);
}

void PcaBuckets::fill_words(const search::DescriptorMatrix& rotated, double factor) {
  const std::size_t places = chunks() * kChunk;
  as_queries_.assign(places * pairs_, 0);
  as_targets_.assign(places * pairs_, 0);
  head_norms_.assign(places, kFarOff);
  norms_.assign(places, kFarOff);
  const auto columns = static_cast<std::size_t>(rotated.cols());
  std::vector<std::int32_t> numbers(static_cast<std::size_t>(rotated.size()));
  round_products(rotated.data(), numbers.size(), static_cast<float>(factor), static_cast<float>(kLongest),
                 numbers.data());
  for (std::size_t place = 0; place < order_.size(); ++place) {
    const std::int32_t* row = numbers.data() + order_[place] * columns;
    std::int32_t norm = 0;
    for (std::size_t p = 0; p < pairs_; ++p) {
      const std::int32_t low = row[2 * p];
      const std::int32_t high = 2 * p + 1 < columns ? row[2 * p + 1] : 0;
      as_queries_[place * pairs_ + p] = word_of(low, high);
      as_targets_[(place / kChunk * pairs_ + p) * kChunk + place % kChunk] = word_of(-2 * low, -2 * high);
      norm += low * low + high * high;
      head_norms_[place] = p < kHeadPairs ? norm : head_norms_[place];
    }
    norms_[place] = norm;
  }
}

void PcaBuckets::fill_boxes(const std::vector<Corner>& heads) {
  of_leaves_ = Boxes(leaves_);
  of_chunks_.assign(leaves_, Boxes(kChunks));
  for (std::size_t place = 0; place < order_.size(); ++place) {
    of_leaves_.add(place / kLeaf, heads[order_[place]].data());
    of_chunks_[place / kLeaf].add(place % kLeaf / kChunk, heads[order_[place]].data());
  }
}

QueryChunk PcaBuckets::queries(std::size_t chunk, const std::int32_t* limits) const {
  const std::size_t first = chunk * kChunk;
  return {as_queries_.data() + first * pairs_, head_norms_.data() + first, norms_.data() + first, limits + first};
}

TargetChunk PcaBuckets::targets(std::size_t chunk, const std::int32_t* limits) const {
  const std::size_t first = chunk * kChunk;
  return {as_targets_.data() + first * pairs_, head_norms_.data() + first, norms_.data() + first, limits + first};
}

/// The lowest and the highest corner of the box around a chunk.
std::pair<PcaBuckets::Corner, PcaBuckets::Corner> PcaBuckets::box_of(std::size_t chunk) const {
  const Boxes& boxes = of_chunks_[chunk / kChunks];
  std::pair<Corner, Corner> corners;
  for (std::size_t d = 0; d < kBox; ++d) {
    corners.first[d] = boxes.low[d * kChunks + chunk % kChunks];
    corners.second[d] = boxes.high[d * kChunks + chunk % kChunks];
  }
  return corners;
}

void PcaBuckets::bounds_to_leaves(const PcaBuckets& other, std::size_t chunk, std::vector<float>& bounds) const {
  bounds.resize(leaves_);
  const auto [low, high] = other.box_of(chunk);
  box_bounds(low.data(), high.data(), of_leaves_.low.data(), of_leaves_.high.data(), leaves_, bounds.data());
}

void PcaBuckets::bounds_to_chunks(const PcaBuckets& other, std::size_t chunk, std::size_t leaf, float* bounds) const {
  const auto [low, high] = other.box_of(chunk);
  const Boxes& boxes = of_chunks_[leaf];
  box_bounds(low.data(), high.data(), boxes.low.data(), boxes.high.data(), kChunks, bounds);
}

}  // namespace loopmark::matching::internal
