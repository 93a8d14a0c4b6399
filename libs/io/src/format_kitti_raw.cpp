// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_kitti_raw() {
  return {"kitti-raw", "KITTI raw: a folder with velodyne_points/data and timestamps.txt", 30, open_kitti_raw};
}

}  // namespace loopmark::io::internal
