// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Between loopmark's types and MRPT's, once at the edge.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "loopmark/core/point_cloud.hpp"

namespace mrpt::poses {
class CPose3D;
class CPose3DPDFGaussian;
}  // namespace mrpt::poses
namespace mrpt::obs {
class CObservation;
class CSensoryFrame;
}  // namespace mrpt::obs

namespace loopmark::mrpt_bridge {

mrpt::poses::CPose3D to_mrpt(const Pose& pose);
Pose from_mrpt(const mrpt::poses::CPose3D& pose);

/// A pose and its covariance. Ours is of xi in exp(xi) * pose, [translation; rotation]; MRPT's is of (x, y, z, yaw,
/// pitch, roll). First order; not for a pitch of +-90 degrees.
mrpt::poses::CPose3DPDFGaussian to_mrpt(const Pose& pose, const Matrix6d& covariance);

/// The covariance of xi in exp(xi) * mean, the inverse of the above.
Matrix6d covariance_from_mrpt(const mrpt::poses::CPose3DPDFGaussian& pdf);

/// The cloud of a CObservationVelodyneScan (with ring and time of each point) or CObservationPointCloud, in the
/// sensor's frame; nothing for other classes. Throws InputError when points that are stored in another file cannot be
/// loaded. A CObservationRotatingScan holds no elevation angles and can therefore not be turned into points.
std::optional<PointCloud> cloud_from_observation(const mrpt::obs::CObservation& observation);

/// The first cloud of a sensory frame, with its stamp; nothing when there is none. Empty label: any sensor.
std::optional<Scan> scan_from_sensory_frame(const mrpt::obs::CSensoryFrame& frame,
                                            const std::string& sensor_label = "");

/// The cloud as an observation: a CObservationVelodyneScan without packets where points have times or rings
/// (intensities rounded to 0..255; those in 0..1 are scaled first), else a CObservationPointCloud.
std::shared_ptr<mrpt::obs::CObservation> observation_from_scan(const Scan& scan, const std::string& sensor_label);

}  // namespace loopmark::mrpt_bridge
