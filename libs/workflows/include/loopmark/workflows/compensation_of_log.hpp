// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/odometry/compensation.hpp"

namespace loopmark::workflows {

/// Measures on a few stretches of the log whether its scans are motion-compensated. Logs of keyframes cannot tell.
odometry::CompensationMeasurement compensation_of_log(const io::DriveLog& log);

/// Why the scans of the log seem to stand in one world frame already instead of the sensor's; empty where nothing shows
/// it.
std::string frame_problem_of_log(const io::DriveLog& log);

/// The verdict and what it rests on, in one line.
std::string describe_measurement(const odometry::CompensationMeasurement& measurement);

}  // namespace loopmark::workflows
