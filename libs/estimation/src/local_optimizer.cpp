// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "local_optimizer.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/estimation/binary_energy.hpp"
#include "loopmark/search/cell_grid.hpp"

namespace loopmark::estimation::internal {
namespace {

std::vector<std::pair<std::size_t, std::size_t>> neighbour_pairs(const PointPairs& pairs, double radius_m) {
  const auto radius = static_cast<float>(radius_m);
  const search::CellGrid grid(pairs.source, radius);
  std::vector<std::pair<std::size_t, std::size_t>> neighbours;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    grid.within(pairs.source[i], radius, [&](std::uint32_t place, float) {
      if (grid.index()[place] > i) {
        neighbours.emplace_back(i, grid.index()[place]);
      }
    });
  }
  return neighbours;
}

}  // namespace

LocalOptimizer::LocalOptimizer(const PointPairs& pairs, const Scorer& scorer, const RansacOptions& options)
    : pairs_(pairs), scorer_(scorer), options_(options) {
  if (options.local == LocalOptimization::kGraphCut) {
    neighbours_ = neighbour_pairs(pairs, options.neighbourhood_m);
  }
}

std::vector<std::size_t> LocalOptimizer::select_inliers(const Pose& T) const {
  return options_.local == LocalOptimization::kGraphCut ? cut_inliers(T) : inliers_of(pairs_, T, options_.threshold_m);
}

/// Labels with the energy of GC-RANSAC (Barath and Matas 2018, Sec. 3.1): unary terms from a Gaussian kernel of the
/// residual; neighbours cost the more, the less their label fits their residuals, and most when they differ.
std::vector<std::size_t> LocalOptimizer::cut_inliers(const Pose& T) const {
  const double scale = options_.threshold_m * options_.score_factor;
  std::vector<double> kernel(pairs_.size());
  BinaryEnergy energy(pairs_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    kernel[i] = std::exp(-squared_residual(pairs_, i, T) / (2.0 * scale * scale));
    energy.add_unary(i, (1.0 - options_.spatial_coherence) * (1.0 - 2.0 * kernel[i]));
  }
  for (const auto& [p, q] : neighbours_) {
    const double mean = 0.5 * (kernel[p] + kernel[q]);
    const double w = options_.spatial_coherence;
    energy.add_pair(p, q, w * mean, w, w, w * (1.0 - mean));
  }
  const std::vector<bool> labels = energy.minimise();
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i]) {
      inliers.push_back(i);
    }
  }
  return inliers;
}

bool LocalOptimizer::round(const std::vector<std::size_t>& inliers, Pose& T, double& score, Rng& rng) const {
  const double before = score;
  const auto offer = [&](const Pose& candidate) {
    const double s = scorer_.score(candidate, score);
    if (s > score) {
      score = s;
      T = candidate;
    }
  };
  offer(fit_rigid(pairs_, inliers));
  // Few inliers: leave some out, so that the trials differ.
  const std::size_t size =
      std::min(options_.local_sample, std::max<std::size_t>(3, inliers.size() - (inliers.size() + 3) / 4));
  std::vector<std::size_t> sample = inliers;
  for (std::size_t trial = 0; trial < options_.local_trials; ++trial) {
    for (std::size_t k = 0; k < size; ++k) {
      std::swap(sample[k], sample[k + rng.below(static_cast<std::uint32_t>(sample.size() - k))]);
    }
    offer(fit_rigid(pairs_, {sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(size)}));
  }
  return score > before;
}

void LocalOptimizer::improve(Pose& T, double& score, Rng& rng) {
  while (rounds_ < options_.local_rounds) {
    ++rounds_;
    const std::vector<std::size_t> inliers = select_inliers(T);
    if (inliers.size() < 4 || !round(inliers, T, score, rng)) {
      return;
    }
  }
}

}  // namespace loopmark::estimation::internal
