// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "file_log.hpp"

#include <utility>

#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "point_times.hpp"

namespace loopmark::io::internal {

void finish_reading(ScanReading& reading, const std::string& scan_name, const LogInfo& info,
                    const LogOptions& options) {
  PointCloud& cloud = reading.scan.cloud;
  const std::size_t senseless = reading.dropped.not_finite + reading.dropped.absurd;
  if (cloud.size() < options.min_points) {
    throw DamagedScan(scan_name, "",
                      std::to_string(cloud.size()) + " usable points, " + std::to_string(senseless) +
                          " that make no sense, where at least " + std::to_string(options.min_points) + " are needed",
                      "leave the scan out, or lower min_points");
  }
  if (senseless > 0) {
    log(Severity::kDebug, scan_name + ": left out " + std::to_string(reading.dropped.not_finite) +
                              " points that are not finite and " + std::to_string(reading.dropped.absurd) +
                              " that are absurdly far away");
  }
  reading.times_in_file = !cloud.time_offset_s.empty();
  if (!reading.times_in_file && info.sweep) {
    cloud.time_offset_s = cloud::times_from_azimuth(cloud.points, *info.sweep);
    reading.times_rebuilt = true;
  }
}

ScanReading FileLog::read_closely(std::size_t index) const {
  PointFile file = read_point_file(parts_.files.at(index), parts_.options);
  if (file.first_time_s) {
    refer_to_stamp(file.cloud.time_offset_s, *file.first_time_s, stamp_s(index));
  }
  ScanReading reading{{index, stamp_s(index), std::move(file.cloud)}, file.dropped, false, false, file.has_viewpoint};
  finish_reading(reading, scan_name(index), parts_.info, parts_.options);
  if (parts_.T_cloud_sensor) {
    reading.scan.cloud = transformed(reading.scan.cloud, *parts_.T_cloud_sensor);
  }
  return reading;
}

}  // namespace loopmark::io::internal
