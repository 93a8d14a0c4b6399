// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/estimation/ransac.hpp"

namespace loopmark::estimation::internal {

/// The sequential probability ratio test (Matas and Chum 2005): looks at pairs in random order until a model is
/// more likely wrong than the threshold allows, and learns the two inlier shares on the way.
class SequentialTest {
 public:
  SequentialTest(const PointPairs& pairs, double threshold_m, Rng& rng);

  /// False: the model is rejected.
  bool passes(const Pose& T_target_source);
  /// A better model with this share of inliers was found.
  void learn_good(double share);

 private:
  void learn_bad(double share);
  void redesign();

  const PointPairs& pairs_;
  double squared_threshold_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0;
  double epsilon_ = 0.1;
  double delta_ = 0.01;
  double threshold_ = 0.0;
  double bad_share_sum_ = 0.0;
  std::size_t bad_count_ = 0;
};

}  // namespace loopmark::estimation::internal
