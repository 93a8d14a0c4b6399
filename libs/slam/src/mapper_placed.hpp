// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/slam/mapper.hpp"

namespace loopmark {

/// A scan on its way into the map.
struct Mapper::Placed {
  TrackedScan tracked;
  ScanState state = ScanState::kTracked;
  std::string problem;
};

}  // namespace loopmark
