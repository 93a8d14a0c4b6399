// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::packets::internal {

/// What an Ouster sensor says of itself.
struct OusterMetadata {
  std::string product;      ///< "OS-1-64"
  std::string profile;      ///< "LEGACY", "RNG19_RFL8_SIG16_NIR16", ...
  std::size_t rows = 0;     ///< pixels in a column
  std::size_t columns = 0;  ///< in a frame
  std::size_t columns_in_packet = 0;
  double frames_per_s = 10.0;
  std::vector<double> elevation_rad, azimuth_rad;  ///< of each row; azimuth against the clock
  double beam_origin_m = 0.0;                      ///< from the axis to where the beams begin
  Pose T_sensor_lidar = Pose::Identity();
};

/// Reads the JSON that the sensor or its driver writes, of old and new firmware. Throws InputError naming what is
/// missing or contradicts itself.
OusterMetadata read_ouster_metadata(const std::filesystem::path& file);

}  // namespace loopmark::packets::internal
