// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Refinement of a hypothesis on patches.
#pragma once

#include "prepared_data.hpp"

namespace loopmark {

struct Alignment {
  Pose T_target_source = Pose::Identity();  ///< between the levelled frames
  Matrix6d information = Matrix6d::Zero();  ///< of the last Gauss-Newton step, tangent on the target's side
  double residual_m = 0.0;                  ///< root mean square of the weighted residuals
  std::size_t used = 0;                     ///< patches with a partner
};

/// Gauss-Newton on source patches against the nearest target patches: the residual counts fully along the normal of a
/// planar patch and partly across it. Geman-McClure weights of scale `scale_m`; partners up to `reach_m`.
Alignment align_patches(const std::vector<Patch>& source, const PatchMap& target, const Pose& start, float reach_m,
                        double scale_m, int iterations);

/// The same with all patches of both scans, each on the nearest of the other: which of the two is the source makes no
/// difference to what is minimised.
Alignment align_both_ways(const PatchMap& source, const PatchMap& target, const Pose& start, float reach_m,
                          double scale_m, int iterations);

/// `count` patches at even steps through the scan, half of them structure where there is enough of it.
std::vector<Patch> sampled(const std::vector<Patch>& patches, std::size_t count);

/// Up to `count` patches of structure at even steps through the scan.
std::vector<Patch> sampled_structure(const std::vector<Patch>& patches, std::size_t count);

/// Up to `count` patches of the ground (height below 0.3 m) at even steps through the scan.
std::vector<Patch> sampled_ground(const std::vector<Patch>& patches, std::size_t count);

}  // namespace loopmark
