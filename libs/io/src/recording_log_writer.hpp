// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "loopmark/io/log_writer.hpp"
#include "loopmark/messages/wire.hpp"
#include "loopmark/recordings/recording_writer.hpp"

namespace loopmark::io::internal {

/// PointCloud2 of a cloud with all channels that it has, encoded.
std::string encode_cloud(messages::Encoding encoding, const Scan& scan, const std::string& frame_id);

class RecordingLogWriter : public LogWriter {
 public:
  RecordingLogWriter(std::unique_ptr<recordings::RecordingWriter> writer, messages::Encoding encoding)
      : writer_(std::move(writer)), encoding_(encoding) {}
  void add(const Scan& scan, const std::optional<Pose>& T_world_lidar) override;
  void add(const Observation& observation) override;
  void add_mounts(const std::map<std::string, Pose>& mounts) override { mounts_ = mounts; }
  void finish() override { writer_->finish(); }

 private:
  void write_mounts(std::int64_t time_ns);
  std::uint32_t channel(const std::string& topic, const std::string& type);

  std::unique_ptr<recordings::RecordingWriter> writer_;
  messages::Encoding encoding_;
  std::map<std::string, std::uint32_t> channels_;
  std::map<std::string, Pose> mounts_;  ///< not written yet
};

}  // namespace loopmark::io::internal
