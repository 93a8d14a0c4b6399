// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/mapping/mapper.hpp"

namespace loopmark::mapping {

/// A scan on its way into the map.
struct Mapper::Placed {
  odometry::TrackedScan tracked;
  map_store::ScanState state = map_store::ScanState::kTracked;
  std::string problem;
  std::string doubt;  ///< why the pose may be wrong though it was tracked; empty: nothing speaks against it
};

}  // namespace loopmark::mapping
