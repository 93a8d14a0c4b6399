// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A log on its way into the map.
#pragma once

#include <string>

#include "input_record.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows::internal {

/// A scan, or why there is none.
struct ReadScan {
  Scan scan;
  std::string problem;
  std::string input;  ///< for the record of the inputs
};

ReadScan read_scan(const io::DriveLog& log, std::size_t index);

/// Every scan of the log behind those that the mapper has goes through it; the next one is read meanwhile. Throws
/// Interrupted when asked to end, with the mapper's state saved.
void feed(mapping::Mapper& mapper, const io::DriveLog& log, InputRecord& inputs, MapTimes& times);

/// The most memory that this process has held, for people.
std::string memory_text();

}  // namespace loopmark::workflows::internal
