// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "feature_index.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace loopmark {
namespace {

using kernels::kBound;
using kernels::kChunk;
using kernels::kChunks;
using kernels::kFine;
using kernels::kHead;
using kernels::kLeaf;
using kernels::kMore;

bool usable(const DescriptorMatrix& m, Eigen::Index r) {
  return m.row(r).allFinite() && m.row(r).cwiseAbs().maxCoeff() > 0.0F;
}

/// Every k-th usable row, a few thousand in all: enough to find the directions.
void add_sample(const DescriptorMatrix& m, std::vector<Eigen::VectorXd>& sample) {
  const Eigen::Index step = std::max<Eigen::Index>(1, m.rows() / 1500);
  for (Eigen::Index r = 0; r < m.rows(); r += step) {
    if (usable(m, r)) {
      sample.emplace_back(m.row(r).transpose().cast<double>());
    }
  }
}

}  // namespace

PrincipalFrame PrincipalFrame::of(const DescriptorMatrix& a, const DescriptorMatrix& b) {
  std::vector<Eigen::VectorXd> sample;
  add_sample(a, sample);
  add_sample(b, sample);
  const Eigen::Index dimension = a.cols();
  PrincipalFrame frame;
  frame.mean = Eigen::VectorXd::Zero(dimension);
  frame.directions = Eigen::MatrixXd::Zero(dimension, static_cast<Eigen::Index>(kHead + kMore));
  for (const Eigen::VectorXd& row : sample) {
    frame.mean += row / static_cast<double>(sample.size());
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(dimension, dimension);
  for (const Eigen::VectorXd& row : sample) {
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(row - frame.mean);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const auto heads = std::min<Eigen::Index>(dimension, static_cast<Eigen::Index>(kHead + kMore));
  frame.directions.leftCols(heads) = solver.eigenvectors().rightCols(heads).rowwise().reverse();
  return frame;
}

FeatureIndex::FeatureIndex(const DescriptorMatrix& descriptors, const PrincipalFrame& frame)
    : padded_((static_cast<std::size_t>(descriptors.cols()) + kernels::kRowStep - 1) / kernels::kRowStep *
              kernels::kRowStep) {
  std::vector<float> bounds(static_cast<std::size_t>(descriptors.rows()) * kFine, 0.0F);
  for (Eigen::Index r = 0; r < descriptors.rows(); ++r) {
    if (!usable(descriptors, r)) {
      continue;
    }
    order_.push_back(static_cast<std::uint32_t>(r));
    const Eigen::VectorXd centred = descriptors.row(r).transpose().cast<double>() - frame.mean;
    const Eigen::VectorXd head = frame.directions.transpose() * centred;
    float* out = bounds.data() + static_cast<std::size_t>(r) * kFine;
    const auto rest = [&](std::size_t used) {
      return static_cast<float>(
          std::sqrt(std::max(0.0, centred.squaredNorm() - head.head(static_cast<Eigen::Index>(used)).squaredNorm())));
    };
    for (std::size_t d = 0; d < kHead; ++d) {
      out[d] = static_cast<float>(head[static_cast<Eigen::Index>(d)]);
    }
    out[kHead] = rest(kHead);
    for (std::size_t d = 0; d < kMore; ++d) {
      out[kBound + d] = static_cast<float>(head[static_cast<Eigen::Index>(kHead + d)]);
    }
    out[kFine - 1] = rest(kHead + kMore);
    largest_ = std::max(largest_, centred.norm());
  }
  leaves_ = (order_.size() + kLeaf - 1) / kLeaf;
  sort_into_leaves(0, static_cast<std::uint32_t>(order_.size()), bounds);
  fill(descriptors, bounds);
}

/// Splits along the widest coordinate, at a multiple of kLeaf, within a leaf of kChunk, until one chunk is left.
void FeatureIndex::sort_into_leaves(std::uint32_t begin, std::uint32_t end, const std::vector<float>& bounds) {
  const std::size_t part = end - begin > kLeaf ? kLeaf : kChunk;
  const std::size_t parts = (end - begin + part - 1) / part;
  if (parts <= 1) {
    return;
  }
  std::array<float, kBound> low;
  std::array<float, kBound> high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::uint32_t i = begin; i < end; ++i) {
    const float* b = bounds.data() + order_[i] * kFine;
    for (std::size_t d = 0; d < kBound; ++d) {
      low[d] = std::min(low[d], b[d]);
      high[d] = std::max(high[d], b[d]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t d = 1; d < kBound; ++d) {
    widest = high[d] - low[d] > high[widest] - low[widest] ? d : widest;
  }
  const std::uint32_t middle = begin + static_cast<std::uint32_t>((parts + 1) / 2 * part);
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float va = bounds[a * kFine + widest];
                     const float vb = bounds[b * kFine + widest];
                     return va < vb || (va == vb && a < b);
                   });
  sort_into_leaves(begin, middle, bounds);
  sort_into_leaves(middle, end, bounds);
}

void FeatureIndex::fill(const DescriptorMatrix& descriptors, const std::vector<float>& bounds) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  rows_.assign(order_.size() * padded_, 0.0F);
  heads_.resize(order_.size() * kFine);
  lanes_.assign(leaves_ * kFine * kLeaf, kInfinity);
  low_.assign(kBound * leaves_, kInfinity);
  high_.assign(kBound * leaves_, -kInfinity);
  boxes_.assign(leaves_ * 2 * kBound * kChunks, kInfinity);
  for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
    const auto high = boxes_.begin() + static_cast<std::ptrdiff_t>((2 * leaf + 1) * kBound * kChunks);
    std::fill_n(high, kBound * kChunks, -kInfinity);
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto columns = static_cast<std::size_t>(descriptors.cols());
    std::copy_n(descriptors.data() + order_[i] * columns, columns, rows_.data() + i * padded_);
    const std::size_t leaf = i / kLeaf;
    for (std::size_t d = 0; d < kFine; ++d) {
      const float value = bounds[order_[i] * kFine + d];
      heads_[i * kFine + d] = value;
      lanes_[(i / kChunk * kFine + d) * kChunk + i % kChunk] = value;
    }
    for (std::size_t d = 0; d < kBound; ++d) {
      const float value = bounds[order_[i] * kFine + d];
      low_[d * leaves_ + leaf] = std::min(low_[d * leaves_ + leaf], value);
      high_[d * leaves_ + leaf] = std::max(high_[d * leaves_ + leaf], value);
      float* low = boxes_.data() + (2 * leaf * kBound + d) * kChunks + i % kLeaf / kChunk;
      float* high = low + kBound * kChunks;
      *low = std::min(*low, value);
      *high = std::max(*high, value);
    }
  }
}

/// One query's state. Places are of the leaf order, the best two in the order (distance, original row).
struct FeatureIndex::Search {
  const float* row = nullptr;
  const float* head = nullptr;
  float slack = 0.0F;
  NearestTwo best;
  std::array<std::size_t, 2> places{};

  /// Bounds at or above this cannot lead to a neighbour: rounding of the bounds is allowed for.
  float threshold() const { return (best.second_squared + slack) * 1.001F; }
};

void FeatureIndex::offer(Search& search, std::size_t place) const {
  const float squared = kernels::row_distance(search.row, row(place), padded_);
  const std::uint32_t id = order_[place];
  NearestTwo& best = search.best;
  const auto before = [&](float d, std::uint32_t other) { return squared < d || (squared == d && id < other); };
  if (id == best.first || id == best.second || !before(best.second_squared, best.second)) {
    return;
  }
  if (before(best.first_squared, best.first)) {
    best.second = best.first;
    best.second_squared = best.first_squared;
    search.places[1] = search.places[0];
    best.first = id;
    best.first_squared = squared;
    search.places[0] = place;
  } else {
    best.second = id;
    best.second_squared = squared;
    search.places[1] = place;
  }
}

void FeatureIndex::search_leaf(Search& search, std::size_t leaf) const {
  std::array<std::uint8_t, kLeaf> hits;
  std::array<float, kLeaf> bounds;
  const std::size_t count =
      kernels::leaf_hits(search.head, lanes_.data() + leaf * kFine * kLeaf, boxes_.data() + leaf * 2 * kBound * kChunks,
                         search.threshold(), bounds.data(), hits.data());
  for (std::size_t k = 0; k < count; ++k) {
    // The threshold falls with every better neighbour. Lanes without a point have no finite bound.
    if (bounds[hits[k]] < search.threshold()) {
      offer(search, leaf * kLeaf + hits[k]);
    }
  }
}

/// What the searches of one chunk of queries share: the leaves that may hold a neighbour of any of them.
struct FeatureIndex::Candidates {
  std::vector<float> bound;  ///< of each leaf, from the box of the queries
  std::vector<std::uint64_t> keys;
  std::vector<float> low, high;  ///< boxes of the candidates, [kBound][candidates]
  std::size_t home = 0;          ///< the leaf nearest to the queries

  std::uint32_t leaf(std::size_t k) const { return static_cast<std::uint32_t>(keys[k]); }
};

void FeatureIndex::nearest_leaf(const FeatureIndex& queries, std::size_t chunk, Candidates& candidates) const {
  std::array<float, kBound> low;
  std::array<float, kBound> high;
  const float* box = queries.boxes_.data() + chunk / kChunks * 2 * kBound * kChunks + chunk % kChunks;
  for (std::size_t d = 0; d < kBound; ++d) {
    low[d] = box[d * kChunks];
    high[d] = box[(kBound + d) * kChunks];
  }
  candidates.bound.resize(leaves_);
  kernels::boxes_bounds(low.data(), high.data(), low_.data(), high_.data(), leaves_, candidates.bound.data());
  const auto& bound = candidates.bound;
  candidates.home = static_cast<std::size_t>(std::min_element(bound.begin(), bound.end()) - bound.begin());
}

/// All but the home leaf whose bound is below the threshold, the nearest first: as keys with the leaf in the low half.
/// Bounds are not negative, so their bits are in the order of their values.
void FeatureIndex::gather(float threshold, Candidates& candidates) const {
  candidates.keys.clear();
  for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
    const float bound = candidates.bound[leaf];
    if (bound < threshold && leaf != candidates.home) {
      candidates.keys.push_back(static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(bound)) << 32U | leaf);
    }
  }
  std::sort(candidates.keys.begin(), candidates.keys.end());
  const std::size_t count = candidates.keys.size();
  candidates.low.resize(kBound * count);
  candidates.high.resize(kBound * count);
  for (std::size_t d = 0; d < kBound; ++d) {
    for (std::size_t k = 0; k < count; ++k) {
      candidates.low[d * count + k] = low_[d * leaves_ + candidates.leaf(k)];
      candidates.high[d * count + k] = high_[d * leaves_ + candidates.leaf(k)];
    }
  }
}

void FeatureIndex::search(const FeatureIndex& queries, std::size_t begin, std::size_t end, double slack,
                          std::vector<NearestTwo>& out) const {
  if (order_.empty()) {
    return;
  }
  Candidates candidates;
  std::vector<float> bound;
  std::array<Search, kChunk> searches;
  std::array<std::size_t, 2> before{0, std::min<std::size_t>(1, order_.size() - 1)};
  for (std::size_t from = begin; from < end; from += kChunk) {
    const std::size_t count = std::min(kChunk, end - from);
    nearest_leaf(queries, from / kChunk, candidates);
    float threshold = 0.0F;
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches[i] = {
          queries.row(from + i), queries.heads_.data() + (from + i) * kFine, static_cast<float>(slack), {}, {}};
      // What the query before found is near to this one too.
      offer(search, before[0]);
      offer(search, before[1]);
      search_leaf(search, candidates.home);
      before = search.best.second == kNoNeighbour ? before : search.places;
      threshold = std::max(threshold, search.threshold());
    }
    gather(threshold, candidates);
    bound.resize(candidates.keys.size());
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches[i];
      kernels::box_bounds(search.head, candidates.low.data(), candidates.high.data(), bound.size(), bound.data());
      for (std::size_t k = 0; k < bound.size(); ++k) {
        if (bound[k] < search.threshold()) {
          search_leaf(search, candidates.leaf(k));
        }
      }
      out[queries.order_[from + i]] = search.best;
    }
  }
}

}  // namespace loopmark
