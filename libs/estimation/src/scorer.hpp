// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "loopmark/estimation/point_pairs.hpp"
#include "score_kernels.hpp"

namespace loopmark::estimation::internal {

/// Scores motions against all pairs.
class Scorer {
 public:
  /// The score is truncated at `threshold_m`.
  Scorer(const PointPairs& pairs, double threshold_m)
      : inverse_squared_(static_cast<float>(1.0 / (threshold_m * threshold_m))) {
    constexpr float kNowhere = 1e15F;
    const std::size_t padded = (pairs.size() + kPairLanes - 1) / kPairLanes * kPairLanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      data_[axis].assign(padded, 0.0F);
      data_[axis + 3].assign(padded, kNowhere);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        data_[axis][i] = pairs.source[i][static_cast<Eigen::Index>(axis)];
        data_[axis + 3][i] = pairs.target[i][static_cast<Eigen::Index>(axis)];
      }
    }
    for (std::size_t k = 0; k < 6; ++k) {
      arrays_.v[k] = data_[k].data();
    }
    arrays_.count = padded;
  }
  Scorer(const Scorer&) = delete;
  Scorer& operator=(const Scorer&) = delete;

  /// The MSAC score, or a number not above `best` when `best` cannot be beaten.
  double score(const Pose& T, double best) const {
    float m[12];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) {
        m[4 * r + c] = static_cast<float>(T.matrix()(r, c));
      }
    }
    return msac_score(arrays_, m, inverse_squared_, static_cast<float>(best));
  }

  const PairArrays& arrays() const { return arrays_; }

 private:
  std::array<std::vector<float>, 6> data_;
  PairArrays arrays_;
  float inverse_squared_;
};

}  // namespace loopmark::estimation::internal
