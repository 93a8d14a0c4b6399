// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/odometry/compensation.hpp"

namespace loopmark::workflows {

/// Measures on a few stretches of the log whether its scans are motion-compensated. Logs of keyframes cannot tell.
odometry::CompensationMeasurement compensation_of_log(const io::DriveLog& log);

/// The verdict and what it rests on, in one line.
std::string describe_measurement(const odometry::CompensationMeasurement& measurement);

}  // namespace loopmark::workflows
