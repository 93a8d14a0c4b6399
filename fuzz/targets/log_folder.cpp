// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/point_files.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {
namespace {

/// A log of three small scans; true.
bool make_scans() {
  set_log_sink([](Severity, const std::string&) {});
  std::filesystem::create_directories(scratch() / "log/velodyne");
  for (int i = 0; i < 3; ++i) {
    PointCloud cloud;
    for (int k = 1; k < 80; ++k) {
      cloud.points.emplace_back(static_cast<float>(k % 9), static_cast<float>(k % 7), static_cast<float>(i));
    }
    io::write_bin(scratch() / "log/velodyne" / ("00000" + std::to_string(i) + ".bin"), cloud);
  }
  return true;
}

}  // namespace

void log_folder(std::string_view bytes) {
  static const bool made = make_scans();
  static_cast<void>(made);
  constexpr std::array kNames = {"log/times.txt", "log/poses.txt", "log/calib.txt", "log/sweep.txt"};
  const std::vector<std::string_view> content = parts(bytes, kNames.size());
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (content[i].empty()) {
      std::filesystem::remove(scratch() / kNames[i]);
    } else {
      written(kNames[i], content[i]);
    }
  }
  reading([] {
    const auto log = io::open_log(scratch() / "log");
    log->truth();
    for (std::size_t i = 0; i < log->size(); ++i) {
      log->stamp_s(i);
      log->read(i);
    }
  });
}

}  // namespace loopmark::fuzz
