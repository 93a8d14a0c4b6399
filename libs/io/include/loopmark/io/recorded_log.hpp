// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Logs from recordings and captures, which hold more than the scans of one sensor.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/observations.hpp"

namespace loopmark::io {

/// One topic of a recording, or what one sensor of a capture sends.
struct TopicFacts {
  std::string topic;
  std::string type;  ///< "sensor_msgs/PointCloud2"
  std::size_t messages = 0;
  std::uint64_t bytes = 0;
  double first_s = 0.0, last_s = 0.0;  ///< when it was recorded
  bool has_scans = false;
  std::string problem;  ///< why its messages cannot be read although they are scans
};

struct RecordingFacts {
  std::vector<TopicFacts> topics;
  std::string topic;                   ///< the one whose scans are taken; LogOptions::sensor_label names another
  std::string topic_reason;            ///< why this one
  std::string topic_content;           ///< its fields, and what its points' times mean
  std::string frame_id;                ///< of its messages
  std::map<std::string, Pose> mounts;  ///< T_lidar_frame of other frames, where the recording has the mounting
};

class RecordedLog : public DriveLog {
 public:
  virtual const RecordingFacts& recording() const = 0;
  /// IMU, GNSS and odometry in the order in which they were recorded; from the file each time, so that none is kept.
  virtual void visit_observations(const ObservationVisitor& visit) const = 0;
};

/// What the log was recorded with; nullptr for logs that hold scans only.
const RecordedLog* as_recorded(const DriveLog& log);

}  // namespace loopmark::io
