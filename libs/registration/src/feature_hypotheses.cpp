// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "feature_hypotheses.hpp"

#include "loopmark/matching/filters.hpp"

namespace loopmark::registration::internal {

std::vector<estimation::PlanarMotion> match_features(const shape_context::Keypoints& source,
                                                     const shape_context::Keypoints& target,
                                                     const FeatureSourceOptions& options) {
  const matching::Correspondences matches =
      matching::correspondences_of(matching::nearest_two(source.descriptors, target.descriptors));
  const matching::Correspondences kept = matching::grid_prioritized_filter(matches, source.points, options.gpf);
  return estimation::find_planar_motions(estimation::PointPairs::of(kept, source.points, target.points),
                                         options.motions);
}

}  // namespace loopmark::registration::internal
