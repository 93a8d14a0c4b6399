// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.hpp"
#include "loopmark/io/log_formats.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_rawlog() {
  return {"rawlog", "MRPT rawlog: a .rawlog file, or a folder with one", 50, open_rawlog};
}

}  // namespace loopmark::io::internal
