// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Measures whether the scans of a drive are motion-compensated: under the right assumption about the sweep, surfaces
/// of neighbouring scans lie closest to each other.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loopmark/cloud/deskew.hpp"
#include "loopmark/core/point_cloud.hpp"
#include "loopmark/odometry/options.hpp"

namespace loopmark::odometry {

/// How well the scans fit each other under one assumption.
struct CompensationTrial {
  Compensation assumption = Compensation::kUnknown;
  double residual_m = 0.0;  ///< mean over the scans of TrackingStatus::residual_m
};

struct CompensationMeasurement {
  Compensation verdict = Compensation::kUnknown;
  std::string reason;                     ///< why it cannot be told; empty when it can
  std::vector<CompensationTrial> trials;  ///< every assumption that was tried
  double speed_m_s = 0.0;                 ///< median over the scans
  double sigmas = 0.0;                    ///< by how many standard errors the best is ahead of the second best
};

/// Follows the sensor through each window of consecutive scans (at least 8; `read` is called from several threads) once
/// for each assumption. `times_given`: the scans' points have times of their own; else both directions of
/// `sweep` are tried. Tells nothing where the sensor hardly moves.
CompensationMeasurement measure_compensation(const std::vector<std::vector<std::size_t>>& windows,
                                             const std::function<Scan(std::size_t)>& read, bool times_given,
                                             const OdometryOptions& options = {}, const cloud::SweepModel& sweep = {});

/// "motion-compensated", "raw, clockwise", ...
const char* compensation_name(Compensation compensation);

}  // namespace loopmark::odometry
