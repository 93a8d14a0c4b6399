// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a log says of motion and place beside its scans, as a stream in the order of recording.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "loopmark/core/pose.hpp"

namespace loopmark::io {

/// Where an observation comes from. Its stamp is the header's where the log has one.
struct ObservationSource {
  double stamp_s = 0.0;
  std::string topic;
  std::string frame_id;
};

struct ImuSample {
  ObservationSource source;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_acceleration_m_s2 = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> orientation;  ///< of the IMU's frame, where it is measured
};

struct GnssFix {
  ObservationSource source;
  double latitude_deg = 0.0, longitude_deg = 0.0;  ///< WGS 84
  double altitude_m = 0.0;                         ///< above the ellipsoid
  int status = 0;  ///< -1 no fix, 0 fix, 1 with satellite, 2 with ground augmentation (RTK)
  std::optional<Eigen::Matrix3d> covariance_m2;  ///< east, north, up
};

/// A pose that something else than this program worked out.
struct OdometrySample {
  ObservationSource source;
  std::string child_frame_id;
  Pose T_frame_child = Pose::Identity();
};

using Observation = std::variant<ImuSample, GnssFix, OdometrySample>;
using ObservationVisitor = std::function<void(const Observation&)>;

}  // namespace loopmark::io
