// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A keyframe that waits for the next scan, as bytes, so that an interrupted run can go on with it.
#pragma once

#include <string>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/map_store/records.hpp"

namespace loopmark::mapping::internal {

struct PendingKeyframe {
  map_store::ScanRecord record;
  Scan scan;  ///< as it was read
};

std::string to_bytes(const PendingKeyframe& pending);

/// Throws InputError on bytes that are cut off or damaged.
PendingKeyframe pending_from_bytes(const std::string& bytes);

}  // namespace loopmark::mapping::internal
