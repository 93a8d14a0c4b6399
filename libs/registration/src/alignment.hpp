// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Refinement of a hypothesis on surfels.
#pragma once

#include "prepared_data.hpp"

namespace loopmark::registration::internal {

struct Alignment {
  Pose T_target_source = Pose::Identity();  ///< between the levelled frames
  Matrix6d information = Matrix6d::Zero();  ///< of the last Gauss-Newton step, tangent on the target's side
  double residual_m = 0.0;                  ///< root mean square of the weighted residuals
  std::size_t used = 0;                     ///< surfels with a partner
};

/// Gauss-Newton on source surfels against the nearest target surfels: the residual counts fully along the normal of a
/// planar surfel and partly across it. Geman-McClure weights of scale `scale_m`; partners up to `reach_m`.
Alignment align_surfels(const std::vector<surfels::Surfel>& source, const surfels::SurfelMap& target, const Pose& start,
                        float reach_m, double scale_m, int iterations);

/// The same with all surfels of both scans, each on the nearest of the other: which of the two is the source makes no
/// difference to what is minimised.
Alignment align_both_ways(const surfels::SurfelMap& source, const surfels::SurfelMap& target, const Pose& start,
                          float reach_m, double scale_m, int iterations);

/// `count` surfels at even steps through the scan, half of them structure where there is enough of it.
std::vector<surfels::Surfel> sampled(const std::vector<surfels::Surfel>& surfels, std::size_t count);

/// Up to `count` surfels of structure at even steps through the scan.
std::vector<surfels::Surfel> sampled_structure(const std::vector<surfels::Surfel>& surfels, std::size_t count);

/// Up to `count` surfels of the ground (height below 0.3 m) at even steps through the scan.
std::vector<surfels::Surfel> sampled_ground(const std::vector<surfels::Surfel>& surfels, std::size_t count);

}  // namespace loopmark::registration::internal
