// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/recorded_log.hpp"

namespace loopmark::io {

const RecordedLog* as_recorded(const DriveLog& log) { return dynamic_cast<const RecordedLog*>(&log); }

}  // namespace loopmark::io
