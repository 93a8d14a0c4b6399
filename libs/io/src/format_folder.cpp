// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_folder() {
  return {"folder",
          "a folder of .bin, .pcd or .ply scans, also in velodyne/ (KITTI odometry: times.txt, poses.txt, calib.txt)",
          40,
          open_folder,
          {"kitti-odometry"}};
}

}  // namespace loopmark::io::internal
