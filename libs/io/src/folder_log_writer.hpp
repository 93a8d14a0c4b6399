// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/io/log_writer.hpp"

namespace loopmark::io::internal {

/// A folder of scans, each a file of its own.
class FolderLogWriter : public LogWriter {
 public:
  FolderLogWriter(const std::filesystem::path& folder, bool pcd);
  ~FolderLogWriter() override;
  void add(const Scan& scan, const std::optional<Pose>& T_world_lidar) override;
  void add(const Observation& /*observation*/) override {}
  void finish() override;

 private:
  std::filesystem::path folder_, partial_;
  bool pcd_;
  bool finished_ = false;
  std::string times_;
  std::vector<Pose> poses_;
  std::size_t scans_ = 0;
};

}  // namespace loopmark::io::internal
