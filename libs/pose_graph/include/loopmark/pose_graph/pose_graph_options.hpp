// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "loopmark/core/options.hpp"

namespace loopmark::pose_graph {

/// How the pose graph is solved and when a loop is doubted.
struct PoseGraphOptions {
  double inlier_chi2 = 22.46;        ///< a loop above it is an outlier; 22.46: 99.9 % quantile, 6 degrees of freedom
  double consistency_chi2 = 22.46;   ///< a cycle of two loops above it is inconsistent
  bool consistency_check = true;     ///< pairwise consistency maximisation (PCM) leaves out loops before any solve
  bool robust = true;                ///< graduated non-convexity (GNC) with truncated least squares on the loops left
  std::size_t min_links = 2;         ///< agreeing loops needed to join two segments that odometry does not connect
  std::size_t max_iterations = 100;  ///< of the last Levenberg-Marquardt solve
  double convexity_step = 1.6;       ///< factor by which each robust step is less convex than the one before
};

template <class Visitor>
void describe(Visitor& v, PoseGraphOptions& o) {
  v.field("inlier_chi2", o.inlier_chi2,
          "a loop above it is an outlier; 22.46: 99.9 % quantile of 6 degrees of freedom");
  v.field("consistency_chi2", o.consistency_chi2, "a cycle of two loops above it is inconsistent");
  v.field("consistency_check", o.consistency_check,
          "pairwise consistency maximisation (PCM) leaves out loops before any solve");
  v.field("robust", o.robust, "graduated non-convexity (GNC) with truncated least squares on the loops left");
  v.field("min_links", o.min_links, "agreeing loops needed to join two segments that odometry does not connect");
  v.field("max_iterations", o.max_iterations, "iterations of the last Levenberg-Marquardt solve");
  v.field("convexity_step", o.convexity_step, "factor by which each robust step is less convex than the one before");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const PoseGraphOptions& options);

}  // namespace loopmark::pose_graph
