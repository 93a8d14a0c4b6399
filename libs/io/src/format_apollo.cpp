// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_apollo() {
  return {"apollo", "Apollo-SouthBay: a folder with pcds/<number>.pcd and poses/gt_poses.txt", 32, open_apollo};
}

}  // namespace loopmark::io::internal
