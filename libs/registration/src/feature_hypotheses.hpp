// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Hypotheses of matched descriptors, the paper's way: mutual and ratio-ordered matches, Grid-Prioritized Filtering,
/// then minimal sets in PROSAC's order with the check of their edges and a least-squares fit to the inliers. Levelled
/// scans need two matches where the paper's need three.
#pragma once

#include <vector>

#include "loopmark/estimation/planar_motions.hpp"
#include "loopmark/registration/engine_options.hpp"
#include "loopmark/shape_context/fourier_shape_context.hpp"

namespace loopmark::registration::internal {

/// Distinct planar motions between the levelled frames, those with the most agreeing matches first.
std::vector<estimation::PlanarMotion> match_features(const shape_context::Keypoints& source,
                                                     const shape_context::Keypoints& target,
                                                     const FeatureSourceOptions& options);

}  // namespace loopmark::registration::internal
