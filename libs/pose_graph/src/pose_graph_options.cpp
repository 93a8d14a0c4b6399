// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pose_graph/pose_graph_options.hpp"

#include "loopmark/core/error.hpp"

namespace loopmark::pose_graph {

void check(const PoseGraphOptions& o) {
  require_option(o.inlier_chi2 > 0.0, "inlier_chi2", "must be positive");
  require_option(o.consistency_chi2 > 0.0, "consistency_chi2", "must be positive");
  require_option(o.min_links >= 1, "min_links", "must be at least 1");
  require_option(o.max_iterations >= 1, "max_iterations", "must be at least 1");
  require_option(o.convexity_step > 1.0, "convexity_step", "must be above 1");
}

}  // namespace loopmark::pose_graph
