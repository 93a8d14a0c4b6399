// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sprt.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace loopmark::estimation::internal {
namespace {

/// Cost of a solve in residuals: a 3 x 3 singular value decomposition against one transformed point.
constexpr double kModelCost = 100.0;
constexpr double kRedesignAt = 0.05;

}  // namespace

SequentialTest::SequentialTest(const PointPairs& pairs, double threshold_m, Rng& rng)
    : pairs_(pairs), squared_threshold_(threshold_m * threshold_m), order_(pairs.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  for (std::size_t i = order_.size(); i > 1; --i) {
    std::swap(order_[i - 1], order_[rng.below(static_cast<std::uint32_t>(i))]);
  }
  redesign();
}

bool SequentialTest::passes(const Pose& T_target_source) {
  const double inlier_factor = delta_ / epsilon_;
  const double outlier_factor = (1.0 - delta_) / (1.0 - epsilon_);
  double ratio = 1.0;
  std::size_t inliers = 0;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const bool inlier = squared_residual(pairs_, order_[next_], T_target_source) < squared_threshold_;
    next_ = next_ + 1 < order_.size() ? next_ + 1 : 0;
    inliers += inlier ? 1U : 0U;
    ratio *= inlier ? inlier_factor : outlier_factor;
    if (ratio > threshold_) {
      learn_bad(static_cast<double>(inliers) / static_cast<double>(k + 1));
      return false;
    }
  }
  return true;
}

void SequentialTest::learn_good(double share) {
  if (share > epsilon_) {
    epsilon_ = std::min(share, 0.999);
    redesign();
  }
}

void SequentialTest::learn_bad(double share) {
  bad_share_sum_ += share;
  ++bad_count_;
  const double mean = std::max(bad_share_sum_ / static_cast<double>(bad_count_), 1e-4);
  if (bad_count_ >= 20 && std::abs(mean - delta_) > kRedesignAt * delta_) {
    delta_ = mean;
    redesign();
  }
}

void SequentialTest::redesign() {
  delta_ = std::min(delta_, 0.5 * epsilon_);
  threshold_ = sprt_threshold(epsilon_, delta_, kModelCost);
}

}  // namespace loopmark::estimation::internal
