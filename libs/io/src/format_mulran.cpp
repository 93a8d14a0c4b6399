// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_mulran() {
  return {"mulran", "MulRan: a folder with Ouster/<nanoseconds>.bin and global_pose.csv", 31, open_mulran};
}

}  // namespace loopmark::io::internal
