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
using kernels::kHead;
using kernels::kLeaf;

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
  frame.directions = Eigen::MatrixXd::Zero(dimension, static_cast<Eigen::Index>(kHead));
  for (const Eigen::VectorXd& row : sample) {
    frame.mean += row / static_cast<double>(sample.size());
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(dimension, dimension);
  for (const Eigen::VectorXd& row : sample) {
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(row - frame.mean);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const auto heads = std::min<Eigen::Index>(dimension, static_cast<Eigen::Index>(kHead));
  frame.directions.leftCols(heads) = solver.eigenvectors().rightCols(heads).rowwise().reverse();
  return frame;
}

FeatureIndex::FeatureIndex(const DescriptorMatrix& descriptors, const PrincipalFrame& frame)
    : padded_((static_cast<std::size_t>(descriptors.cols()) + kernels::kRowStep - 1) / kernels::kRowStep *
              kernels::kRowStep) {
  std::vector<float> bounds(static_cast<std::size_t>(descriptors.rows()) * kBound, 0.0F);
  for (Eigen::Index r = 0; r < descriptors.rows(); ++r) {
    if (!usable(descriptors, r)) {
      continue;
    }
    order_.push_back(static_cast<std::uint32_t>(r));
    const Eigen::VectorXd centred = descriptors.row(r).transpose().cast<double>() - frame.mean;
    const Eigen::VectorXd head = frame.directions.transpose() * centred;
    const double rest = std::sqrt(std::max(0.0, centred.squaredNorm() - head.squaredNorm()));
    float* out = bounds.data() + static_cast<std::size_t>(r) * kBound;
    for (std::size_t d = 0; d < kHead; ++d) {
      out[d] = static_cast<float>(head[static_cast<Eigen::Index>(d)]);
    }
    out[kHead] = static_cast<float>(rest);
    largest_ = std::max(largest_, centred.norm());
  }
  leaves_ = (order_.size() + kLeaf - 1) / kLeaf;
  sort_into_leaves(0, static_cast<std::uint32_t>(order_.size()), bounds);
  fill(descriptors, bounds);
}

/// Splits along the widest coordinate, at a multiple of kLeaf, until one leaf is left.
void FeatureIndex::sort_into_leaves(std::uint32_t begin, std::uint32_t end, const std::vector<float>& bounds) {
  const std::size_t leaves = (end - begin + kLeaf - 1) / kLeaf;
  if (leaves <= 1) {
    return;
  }
  std::array<float, kBound> low;
  std::array<float, kBound> high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::uint32_t i = begin; i < end; ++i) {
    const float* b = bounds.data() + order_[i] * kBound;
    for (std::size_t d = 0; d < kBound; ++d) {
      low[d] = std::min(low[d], b[d]);
      high[d] = std::max(high[d], b[d]);
    }
  }
  std::size_t widest = 0;
  for (std::size_t d = 1; d < kBound; ++d) {
    widest = high[d] - low[d] > high[widest] - low[widest] ? d : widest;
  }
  const std::uint32_t middle = begin + static_cast<std::uint32_t>((leaves + 1) / 2 * kLeaf);
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float va = bounds[a * kBound + widest];
                     const float vb = bounds[b * kBound + widest];
                     return va < vb || (va == vb && a < b);
                   });
  sort_into_leaves(begin, middle, bounds);
  sort_into_leaves(middle, end, bounds);
}

void FeatureIndex::fill(const DescriptorMatrix& descriptors, const std::vector<float>& bounds) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  rows_.assign(order_.size() * padded_, 0.0F);
  heads_.resize(order_.size() * kBound);
  lanes_.assign(leaves_ * kBound * kLeaf, kInfinity);
  low_.assign(kBound * leaves_, kInfinity);
  high_.assign(kBound * leaves_, -kInfinity);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto columns = static_cast<std::size_t>(descriptors.cols());
    std::copy_n(descriptors.data() + order_[i] * columns, columns, rows_.data() + i * padded_);
    const std::size_t leaf = i / kLeaf;
    for (std::size_t d = 0; d < kBound; ++d) {
      const float value = bounds[order_[i] * kBound + d];
      heads_[i * kBound + d] = value;
      lanes_[(leaf * kBound + d) * kLeaf + i % kLeaf] = value;
      low_[d * leaves_ + leaf] = std::min(low_[d * leaves_ + leaf], value);
      high_[d * leaves_ + leaf] = std::max(high_[d * leaves_ + leaf], value);
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
  std::array<std::uint8_t, kLeaf + 1> hits;
  const std::size_t count =
      kernels::leaf_hits(search.head, lanes_.data() + leaf * kBound * kLeaf, search.threshold(), hits.data());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t place = leaf * kLeaf + hits[k];
    if (place < order_.size()) {
      offer(search, place);
    }
  }
}

namespace {

/// The leaves whose bound is below the threshold, the nearest first: as keys with the leaf in the low half. Bounds are
/// not negative, so their bits are in the order of their values.
std::size_t nearest_leaves(const std::vector<float>& bound, float threshold, std::vector<std::uint64_t>& keys) {
  std::size_t count = 0;
  for (std::size_t leaf = 0; leaf < bound.size(); ++leaf) {
    keys[count] = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(bound[leaf])) << 32U | leaf;
    count += bound[leaf] < threshold ? 1U : 0U;
  }
  std::sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

}  // namespace

void FeatureIndex::search(const FeatureIndex& queries, std::size_t begin, std::size_t end, double slack,
                          std::vector<NearestTwo>& out) const {
  if (order_.empty()) {
    return;
  }
  std::vector<float> bound(leaves_);
  std::vector<std::uint64_t> candidates(leaves_ + 1);
  std::array<std::size_t, 2> before{0, std::min<std::size_t>(1, order_.size() - 1)};
  for (std::size_t i = begin; i < end; ++i) {
    Search search{queries.row(i), queries.heads_.data() + i * kBound, static_cast<float>(slack), {}, {}};
    // What the query before found is near to this one too.
    offer(search, before[0]);
    offer(search, before[1]);
    kernels::box_bounds(search.head, low_.data(), high_.data(), leaves_, bound.data());
    const auto home = static_cast<std::size_t>(std::min_element(bound.begin(), bound.end()) - bound.begin());
    search_leaf(search, home);
    const std::size_t count = nearest_leaves(bound, search.threshold(), candidates);
    for (std::size_t c = 0; c < count; ++c) {
      const auto leaf = static_cast<std::size_t>(candidates[c] & 0xFFFFFFFFU);
      if (!(bound[leaf] < search.threshold())) {
        break;
      }
      if (leaf != home) {
        search_leaf(search, leaf);
      }
    }
    out[queries.order_[i]] = search.best;
    before = search.best.second == kNoNeighbour ? before : search.places;
  }
}

}  // namespace loopmark
