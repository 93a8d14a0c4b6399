// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "inverted_file.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::places::internal {
namespace {

constexpr std::uint64_t kSeed = 20;
constexpr int kRounds = 6;               ///< of k-means
constexpr Eigen::Index kPerCentre = 24;  ///< vectors a centre is learned from
constexpr std::size_t kProbes = 48;      ///< cells a query looks into

}  // namespace

Eigen::MatrixXf projection(Eigen::Index size) {
  Rng rng(task_seed(kSeed, {static_cast<std::uint64_t>(size)}));
  Eigen::MatrixXf m(kShort, size);
  for (Eigen::Index c = 0; c < size; ++c) {
    for (Eigen::Index r = 0; r < kShort; ++r) {
      m(r, c) = static_cast<float>(rng.normal() / std::sqrt(static_cast<double>(kShort)));
    }
  }
  return m;
}

std::uint32_t InvertedFile::nearest_cell(const Eigen::VectorXf& vector) const {
  Eigen::Index best = 0;
  (centres_.colwise() - vector).colwise().squaredNorm().minCoeff(&best);
  return static_cast<std::uint32_t>(best);
}

std::vector<std::uint32_t> InvertedFile::nearest_cells(const Eigen::VectorXf& query) const {
  const Eigen::VectorXf distances = (centres_.colwise() - query).colwise().squaredNorm();
  std::vector<std::uint32_t> order(cells_.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(kProbes, order.size()));
  std::partial_sort(order.begin(), end, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return distances[a] < distances[b] || (distances[a] == distances[b] && a < b);
  });
  order.erase(end, order.end());
  return order;
}

void InvertedFile::learn_centres(const Eigen::MatrixXf& vectors, Eigen::Index count) {
  // Evenly spread over the drive, to begin with and to learn from.
  const Eigen::Index used = std::min(vectors.cols(), count * kPerCentre);
  Eigen::MatrixXf sample(kShort, used);
  for (Eigen::Index i = 0; i < used; ++i) {
    sample.col(i) = vectors.col(i * vectors.cols() / used);
  }
  centres_.resize(kShort, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    centres_.col(c) = sample.col(c * used / count);
  }
  std::vector<std::uint32_t> nearest(static_cast<std::size_t>(used));
  for (int round = 0; round < kRounds; ++round) {
    parallel_for(
        nearest.size(), [&](std::size_t i) { nearest[i] = nearest_cell(sample.col(static_cast<Eigen::Index>(i))); },
        64);
    Eigen::MatrixXf sums = Eigen::MatrixXf::Zero(kShort, count);
    Eigen::VectorXf members = Eigen::VectorXf::Zero(count);
    for (Eigen::Index i = 0; i < used; ++i) {
      sums.col(nearest[static_cast<std::size_t>(i)]) += sample.col(i);
      members[nearest[static_cast<std::size_t>(i)]] += 1.0F;
    }
    for (Eigen::Index c = 0; c < count; ++c) {
      if (members[c] > 0.0F) {
        centres_.col(c) = sums.col(c) / members[c];
      }
    }
  }
}

void InvertedFile::build(const Eigen::MatrixXf& vectors) {
  learn_centres(vectors, static_cast<Eigen::Index>(2.0 * std::sqrt(static_cast<double>(vectors.cols()))));
  cells_.assign(static_cast<std::size_t>(centres_.cols()), {});
  size_ = 0;
  std::vector<std::uint32_t> nearest(static_cast<std::size_t>(vectors.cols()));
  parallel_for(
      nearest.size(), [&](std::size_t i) { nearest[i] = nearest_cell(vectors.col(static_cast<Eigen::Index>(i))); }, 64);
  for (const std::uint32_t c : nearest) {
    const float* vector = vectors.col(static_cast<Eigen::Index>(size_)).data();
    cells_[c].places.push_back(static_cast<std::uint32_t>(size_++));
    cells_[c].members.insert(cells_[c].members.end(), vector, vector + kShort);
  }
}

void InvertedFile::add(const Eigen::VectorXf& vector) {
  Cell& cell = cells_[nearest_cell(vector)];
  cell.places.push_back(static_cast<std::uint32_t>(size_++));
  cell.members.insert(cell.members.end(), vector.data(), vector.data() + kShort);
}

}  // namespace loopmark::places::internal
